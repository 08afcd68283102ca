// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "features/motion/motion_gradient.hpp"
#include "random_model.hpp"
#include "readers/synthetic/synthetic_cameras.hpp"

namespace {

using namespace gs::features;

constexpr motion_scale scale{3, 1 / 40.0};

constexpr std::array lenses{gs::lens_model::pinhole, gs::lens_model::fisheye};

struct drawn_case {
    gs::lens_model lens;
    bool antialiased;
};
constexpr std::array<drawn_case, 4> cases{{{gs::lens_model::pinhole, false},
                                           {gs::lens_model::pinhole, true},
                                           {gs::lens_model::fisheye, false},
                                           {gs::lens_model::fisheye, true}}};

gs::camera moving(gs::lens_model lens, const motion_values& values) {
    gs::camera c{44, 33, 40, 42, 21, 17};
    c.rotation = glm::mat3_cast(glm::normalize(glm::dquat(1, 0.3, -0.2, 0.4)));
    c.translation = {0.2, -0.1, 3};
    if (lens == gs::lens_model::fisheye) c.fisheye = gs::fisheye({0.04, -0.012, 0.003, -0.0004});
    c.motion = motion_of(scale, values);
    return c;
}

std::vector<float> random_weights(const gs::camera& c) {
    std::mt19937 random(3);
    std::vector<float> weights(3u * static_cast<unsigned>(c.width * c.height));
    for (float& w : weights) w = std::normal_distribution<float>()(random);
    return weights;
}

double weighted_sum(const double* render, const std::vector<float>& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += static_cast<double>(weights[i]) * render[i];
    return sum;
}

/// Central differences of two steps, the larger of which is tiny, because a step over the edge of a splat
/// has a jump.
struct differences {
    double fine, coarse;
    bool agree(double magnitude) const {
        return fine == doctest::Approx(coarse).epsilon(1e-4).scale(magnitude);
    }
};

}  // namespace

TEST_CASE("motion: gradients by a motion are those of central differences in double precision") {
    int jumps = 0;
    for (const auto [lens, antialiased] : cases)
        for (const motion_values& values :
             {motion_values{2, -1, 0.5f, 0, 0, 0, 0}, motion_values{1, 4, -3, 2, -3, 5, 1.5f},
              motion_values{-3, 2, 1, 1, 6, -2, -0.7f}}) {
            CAPTURE(static_cast<int>(lens));
            CAPTURE(antialiased);
            CAPTURE(values[0]);
            const std::vector<float> weights = random_weights(moving(lens, values));
            drawing<double> exact(antialiased);
            const auto loss = [&](const motion_values& at) {
                return weighted_sum(exact.draw(moving(lens, at)), weights);
            };
            drawing<float> trained(antialiased);
            trained.draw(moving(lens, values));
            const float* sums =
                trained.renderer.backward_to_splats(weights.data(), 1, gs::accumulator::native);
            constexpr std::size_t lanes = gs::device::cpu::narrow_warp::size;
            constexpr std::size_t warps = (model<float>::count + lanes - 1) / lanes;
            std::vector<float> parts(motion_width * warps);
            trained.renderer.backward_from_splats(sums, 0, motion_gradient(scale, {parts.data(), warps}),
                                                  nullptr);
            const auto difference = [&](unsigned k, float half_step) {
                motion_values more = values, less = values;
                more[k] += half_step;
                less[k] -= half_step;
                return (loss(more) - loss(less)) /
                       (static_cast<double>(more[k]) - static_cast<double>(less[k]));
            };
            std::array<double, motion_width> found{};
            for (unsigned k = 0; k < motion_width; ++k)
                for (std::size_t w = 0; w < warps; ++w) found[k] += static_cast<double>(parts[k * warps + w]);
            const double most =
                std::abs(*std::ranges::max_element(found, {}, [](double x) { return std::abs(x); }));
            CHECK(most > 0.1);
            for (unsigned k = 0; k < motion_width; ++k) {
                CAPTURE(k);
                const differences d{difference(k, 4e-6f), difference(k, 8e-6f)};
                if (!d.agree(most)) {
                    ++jumps;
                    continue;
                }
                CHECK(found[k] == doctest::Approx(d.coarse).epsilon(2e-3).scale(most));
            }
        }
    CHECK(jumps <= 8);
}

TEST_CASE("motion: gradients of the Gaussians of a moving camera are those of central differences") {
    for (const auto [lens, antialiased] : cases) {
        CAPTURE(static_cast<int>(lens));
        CAPTURE(antialiased);
        const gs::camera camera = moving(lens, {1, 4, -3, 2, -3, 5, 1.5f});
        const std::vector<float> weights = random_weights(camera);
        const std::vector<double> wide_weights(weights.begin(), weights.end());
        drawing<double> exact(antialiased), stepped(antialiased);
        exact.draw(camera);
        model<double> gradient = exact.gaussians;
        gs::parameter_arrays<double> to;
        to.mean = gradient.values[0].data();
        to.log_scale = gradient.values[1].data();
        to.quaternion = gradient.values[2].data();
        to.opacity = gradient.values[3].data();
        for (std::size_t k = 0; k < 4; ++k) to.sh[k] = gradient.values[4 + k].data();
        exact.renderer.backward(wide_weights.data(), 1, gs::accumulator::native, 2,
                                gs::raster::store_gradients<double>{to}, nullptr);
        int checked = 0, jumps = 0;
        for (std::size_t p = 0; p < 4; ++p) {
            CAPTURE(p);
            double most = 0;
            for (const double g : gradient.values[p]) most = std::max(most, std::abs(g));
            for (std::size_t i = 0;
                 i < model<double>::count * static_cast<std::size_t>(gs::parameter_width[p]); i += 4) {
                CAPTURE(i);
                double& value = stepped.gaussians.values[p][i];
                const double before = value;
                const auto difference = [&](double half_step) {
                    value = before + half_step;
                    const double more = weighted_sum(stepped.draw(camera), weights);
                    value = before - half_step;
                    const double less = weighted_sum(stepped.draw(camera), weights);
                    value = before;
                    return (more - less) / (2 * half_step);
                };
                const differences d{difference(1e-7), difference(2e-7)};
                if (!d.agree(most)) {
                    ++jumps;
                    continue;
                }
                ++checked;
                CHECK(gradient.values[p][i] == doctest::Approx(d.coarse).epsilon(1e-4).scale(most));
            }
        }
        CHECK(checked > 80);
        CHECK(jumps < checked / 20);
    }
}

TEST_CASE("motion: a render with a motion is close to what a moving camera sees") {
    // A row sees the scene as it is while the row is exposed.
    const auto seen_by = [](const gs::camera& moving) {
        const int times = moving.motion->exposure == 0 ? 1 : 10;
        const std::size_t pixels = static_cast<std::size_t>(moving.width * moving.height);
        std::vector<double> sum(3 * pixels);
        drawing<double> exact(true);
        const auto width = static_cast<std::size_t>(moving.width), height = pixels / width;
        for (std::size_t row = 0; row < (moving.motion->readout == 0 ? 1 : height); ++row)
            for (int i = 0; i < times; ++i) {
                const double read = moving.motion->readout *
                                    ((static_cast<double>(row) + 0.5) / static_cast<double>(height) - 0.5);
                gs::camera now =
                    gs::at_time(moving, read + moving.motion->exposure * ((i + 0.5) / times - 0.5));
                now.motion.reset();
                const double* render = exact.draw(now);
                for (std::size_t k = 0; k < sum.size(); ++k)
                    if (moving.motion->readout == 0 || k % pixels / width == row) sum[k] += render[k] / times;
            }
        return sum;
    };
    for (const gs::lens_model lens : lenses)
        for (const gs::camera_motion& motion :
             {gs::camera_motion{{0.03, 0.08, 0.1}, {0.1, 0, 0.2}, 1, 0},
              gs::camera_motion{{-0.02, 0.1, 0}, {0, 0, 0}, 0, 1},
              gs::camera_motion{{0.03, -0.025, 0}, {0, 0.05, 0}, 1.4, -1.5}}) {
            gs::camera camera = moving(lens, {});
            camera.motion = motion;
            CAPTURE(static_cast<int>(lens));
            CAPTURE(motion.exposure);
            CAPTURE(motion.readout);
            const std::vector<double> expected = seen_by(camera);
            drawing<double> exact(true);
            const auto difference = [&](const gs::camera& c) {
                const double* render = exact.draw(c);
                double square = 0;
                for (std::size_t i = 0; i < expected.size(); ++i)
                    square += std::pow(render[i] - expected[i], 2);
                return std::sqrt(square / static_cast<double>(expected.size()));
            };
            const double with = difference(camera);
            camera.motion.reset();
            // The rows of a splat are read one after another, which shears it. The renders ignore this.
            CHECK(with < (motion.readout == 0 ? 0.4 : 0.6) * difference(camera));
        }
}

TEST_CASE("motion: a motion of any size gives a finite render and finite gradients") {
    for (const auto [lens, antialiased] : cases)
        for (const float size : {1e-30f, 1e4f, 1e12f, 1e30f})
            for (const float readout : {0.0f, -1e6f, 1e30f}) {
                CAPTURE(static_cast<int>(lens));
                CAPTURE(antialiased);
                CAPTURE(size);
                CAPTURE(readout);
                const gs::camera camera = moving(lens, {size, -size, size, size, 0, size, readout});
                const std::vector<float> weights = random_weights(camera);
                drawing<float> trained(antialiased);
                const float* render = trained.draw(camera);
                CHECK(std::all_of(render, render + weights.size(), [](float x) { return std::isfinite(x); }));
                const float* sums =
                    trained.renderer.backward_to_splats(weights.data(), 1, gs::accumulator::native);
                std::vector<float> parts(motion_width * model<float>::count);
                trained.renderer.backward_from_splats(
                    sums, 0, motion_gradient(scale, {parts.data(), model<float>::count}), nullptr);
                CHECK(std::ranges::all_of(parts, [](float x) { return std::isfinite(x); }));
            }
}
