// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

#pragma once

/// Inputs for the kernels of this folder, launches of the kernels, and their results by serial code in
/// double precision. The launches are templates, so that they also run kernels with bugs.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>
#include <warpagg/emulate_cuda.hpp>

namespace {

using warpagg::emulator::cuda_grid;
using warpagg::emulator::device_array;
using warpagg::emulator::report;
using warpagg::emulator::try_launch;

/// Compares with a reference. A sum of rounded terms differs by a fraction of the sum of their magnitudes.
template <class Values>
void check_sums(const Values& got, const std::vector<double>& wanted, const std::vector<double>& magnitudes) {
    REQUIRE(got.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        INFO("element ", i);
        CHECK(std::abs(static_cast<double>(got[i]) - wanted[i]) <= 1e-5 * (1e-3 + magnitudes[i]));
    }
}

/// A sum in double precision, with the sum of the magnitudes of its terms.
struct double_sums {
    std::vector<double> sums, magnitudes;
    explicit double_sums(std::size_t n) : sums(n), magnitudes(n) {}
    void add(std::size_t i, double v) {
        sums[i] += v;
        magnitudes[i] += std::abs(v);
    }
};

/// Gaussians on a small image of 2x2 tiles, the right and the lower ones cut off. Every tile lists all of
/// them.
struct blend_scene {
    static constexpr int width = 20, height = 18;
    static constexpr float3 background = {0.1f, 0.2f, 0.3f};
    unsigned n;
    std::vector<uint2> ranges;
    std::vector<unsigned> list;
    std::vector<float2> means;
    std::vector<float4> conics;
    std::vector<float3> colors, dL_dpixels;
    std::vector<float> transmittances;
    std::vector<int> last;
    double_sums dL_dcolors, dL_dmeans, dL_dconics, dL_dopacities;

    explicit blend_scene(unsigned gaussians)
        : n(gaussians), dL_dcolors(3 * n), dL_dmeans(2 * n), dL_dconics(3 * n), dL_dopacities(n) {
        std::mt19937 random(1);
        const auto uniform = [&](float from, float to) {
            return from + (to - from) * static_cast<float>(random() >> 8) / static_cast<float>(1u << 24);
        };
        for (unsigned i = 0; i < n; ++i) {
            means.push_back({uniform(0, width), uniform(0, height)});
            const float xx = uniform(0.1f, 1), yy = uniform(0.1f, 1);
            conics.push_back({xx, uniform(-0.5f, 0.5f) * std::sqrt(xx * yy), yy, uniform(0.2f, 1)});
            colors.push_back({uniform(0, 1), uniform(0, 1), uniform(0, 1)});
        }
        for (unsigned tile = 0; tile < 4; ++tile) {
            ranges.push_back({tile * n, tile * n + n});
            for (unsigned i = 0; i < n; ++i) list.push_back((i * 7 + tile) % n);
        }
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                dL_dpixels.push_back({uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
                blend_pixel(x, y);
            }
    }

    /// Blends front to back; then adds the gradients, with sums over the Gaussians behind each one.
    void blend_pixel(int x, int y) {
        struct shown {
            unsigned id;
            double dx, dy, falloff, alpha, T;
        };
        std::vector<shown> all;
        double T = 1;
        int number = 0, last_shown = 0;
        const uint2 range = ranges[static_cast<unsigned>(y / 16 * 2 + x / 16)];
        for (unsigned k = range.x; k < range.y; ++k) {
            ++number;
            const unsigned id = list[k];
            const double dx = means[id].x - static_cast<float>(x), dy = means[id].y - static_cast<float>(y);
            const float4 c = conics[id];
            const double power = -0.5 * (c.x * dx * dx + c.z * dy * dy) - c.y * dx * dy;
            const double falloff = std::exp(power), alpha = std::min(0.99, c.w * falloff);
            if (power > 0 || alpha < 1.0 / 255) continue;
            all.push_back({id, dx, dy, falloff, alpha, T});
            T *= 1 - alpha;
            last_shown = number;
            if (T < 0.01) break;
        }
        transmittances.push_back(static_cast<float>(T));
        last.push_back(last_shown);

        const float3 g = dL_dpixels.back();
        double behind = T * (background.x * g.x + background.y * g.y + background.z * g.z);
        for (auto s = all.rbegin(); s != all.rend(); ++s) {
            const float4 c = conics[s->id];
            const double color = colors[s->id].x * g.x + colors[s->id].y * g.y + colors[s->id].z * g.z;
            const double dL_dalpha = s->T * color - behind / (1 - s->alpha);
            behind += s->T * s->alpha * color;
            const double dL_dpower = dL_dalpha * c.w * s->falloff;
            dL_dcolors.add(3 * s->id + 0, s->alpha * s->T * g.x);
            dL_dcolors.add(3 * s->id + 1, s->alpha * s->T * g.y);
            dL_dcolors.add(3 * s->id + 2, s->alpha * s->T * g.z);
            dL_dmeans.add(2 * s->id + 0, -dL_dpower * (c.x * s->dx + c.y * s->dy));
            dL_dmeans.add(2 * s->id + 1, -dL_dpower * (c.z * s->dy + c.y * s->dx));
            dL_dconics.add(3 * s->id + 0, -0.5 * dL_dpower * s->dx * s->dx);
            dL_dconics.add(3 * s->id + 1, -dL_dpower * s->dx * s->dy);
            dL_dconics.add(3 * s->id + 2, -0.5 * dL_dpower * s->dy * s->dy);
            dL_dopacities.add(s->id, dL_dalpha * s->falloff);
        }
    }

    /// Runs the kernel. Compares its results if it is not diagnosed.
    template <class Kernel>
    report run(Kernel* kernel, std::uint64_t seed) const {
        device_array<float> to_colors(3 * n, 0.0f), to_means(2 * n, 0.0f), to_conics(3 * n, 0.0f);
        device_array<float> to_opacities(n, 0.0f);
        const report r =
            try_launch(kernel, {.blocks = {2, 2}, .threads = {16, 16}, .seed = seed}, device_array(ranges),
                       device_array(list), width, height, device_array(means), device_array(conics),
                       device_array(colors), background, device_array(transmittances), device_array(last),
                       device_array(dL_dpixels), to_colors, to_means, to_conics, to_opacities);
        if (r.ok()) {
            check_sums(to_colors, dL_dcolors.sums, dL_dcolors.magnitudes);
            check_sums(to_means, dL_dmeans.sums, dL_dmeans.magnitudes);
            check_sums(to_conics, dL_dconics.sums, dL_dconics.magnitudes);
            check_sums(to_opacities, dL_dopacities.sums, dL_dopacities.magnitudes);
        }
        return r;
    }
};

/// Points in a grid of three levels: the first is dense, the others are hashed.
struct hash_grid_scene {
    static constexpr unsigned n = 100, entries = 128;
    std::vector<unsigned> resolutions{4, 8, 16};
    std::vector<float3> points;
    std::vector<float2> dL_dfeatures;
    double_sums dL_dtables{2 * 3 * entries};

    hash_grid_scene() {
        std::mt19937 random(1);
        const auto uniform = [&] { return static_cast<float>(random() >> 8) / static_cast<float>(1u << 24); };
        for (unsigned i = 0; i < n; ++i) points.push_back({uniform(), uniform(), uniform()});
        for (unsigned i = 0; i < 3 * n; ++i) dL_dfeatures.push_back({uniform() - 0.5f, uniform() - 0.5f});
        for (unsigned level = 0; level < 3; ++level)
            for (unsigned i = 0; i < n; ++i) add_point(level, i);
    }

    /// Walks the grid points around a point, with weights from their distances.
    void add_point(unsigned level, unsigned i) {
        const unsigned cells = resolutions[level], side = cells + 1;
        const auto scale = static_cast<float>(cells);
        const double p[3] = {points[i].x * scale, points[i].y * scale, points[i].z * scale};
        const auto low = [&](int axis) { return static_cast<unsigned>(p[axis]); };
        for (unsigned z = low(2); z <= low(2) + 1; ++z)
            for (unsigned y = low(1); y <= low(1) + 1; ++y)
                for (unsigned x = low(0); x <= low(0) + 1; ++x) {
                    const double weight =
                        (1 - std::abs(p[0] - x)) * (1 - std::abs(p[1] - y)) * (1 - std::abs(p[2] - z));
                    const unsigned at = side * side * side <= entries
                                            ? x + side * y + side * side * z
                                            : (x ^ (y * 2654435761u) ^ (z * 805459861u)) % entries;
                    dL_dtables.add(2 * (level * entries + at), weight * dL_dfeatures[level * n + i].x);
                    dL_dtables.add(2 * (level * entries + at) + 1, weight * dL_dfeatures[level * n + i].y);
                }
    }

    template <class Kernel>
    report run(Kernel* kernel, std::uint64_t seed) const {
        device_array<float2> tables(std::size_t{3} * entries, float2{0, 0});
        const report r =
            try_launch(kernel, {.blocks = {2, 3}, .threads = 64, .seed = seed}, device_array(points), n,
                       device_array(resolutions), entries, device_array(dL_dfeatures), tables);
        if (r.ok()) {
            std::vector<float> got;
            for (const float2& v : tables) got.insert(got.end(), {v.x, v.y});
            check_sums(got, dL_dtables.sums, dL_dtables.magnitudes);
        }
        return r;
    }
};

/// Numbers whose sum is exact in any order; every third is positive.
struct sum_scene {
    static constexpr unsigned n = 1000;
    std::vector<float> values;
    float sum = 0;
    unsigned count = 0;

    sum_scene() {
        for (unsigned i = 0; i < n; ++i) {
            values.push_back(i % 3 == 1 ? static_cast<float>(i) : -1.0f);
            sum += i % 3 == 1 ? static_cast<float>(i) : 0.0f;
            count += i % 3 == 1 ? 1 : 0;
        }
    }

    template <class Kernel>
    report run(Kernel* kernel, std::uint64_t seed) const {
        device_array<float> to_sum{0.0f};
        device_array<unsigned> to_count{0u};
        const report r = try_launch(kernel, {.blocks = 4, .threads = 96, .seed = seed}, device_array(values),
                                    n, to_sum, to_count);
        if (r.ok()) {
            CHECK(to_sum[0] == sum);
            CHECK(to_count[0] == count);
        }
        return r;
    }
};

}  // namespace
