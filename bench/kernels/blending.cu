// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Scenes and policies for the backward pass of the splatting rasterizers.

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "blending_kernel.hpp"
#include "kernel.hpp"

namespace {

namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace gate = warpagg::gate;
using warpagg::policy;

/// A frame of random Gaussians, which are listed for each tile that the square around their ellipse
/// touches, as in the original.
template <int Channels>
class scene {
  public:
    scene(unsigned gaussians, unsigned width, unsigned height, float smallest_sigma, float largest_sigma,
          float largest_opacity, float reach)
        : scene(gaussians, width, height,
                draw(gaussians, width, height, smallest_sigma, largest_sigma, largest_opacity, reach)) {}

    static kernel_case with_arrays(std::shared_ptr<const scene>, const char* input);
    static kernel_case with_record(std::shared_ptr<const scene>, const char* input);

  private:
    struct drawn {
        std::vector<float2> mean;
        std::vector<float4> conic_opacity;
        std::vector<float> color, pixel_grad;
        std::vector<unsigned> list;
        std::vector<uint2> range;
    };
    static drawn draw(unsigned gaussians, unsigned width, unsigned height, float smallest, float largest,
                      float largest_opacity, float reach) {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> unit(0, 1);
        drawn d;
        const unsigned tiles_x = (width + tile - 1) / tile, tiles_y = (height + tile - 1) / tile;
        std::vector<std::vector<unsigned>> of_tile(tiles_x * tiles_y);
        for (unsigned i = 0; i < gaussians; ++i) {
            const float2 mean{unit(random) * static_cast<float>(width),
                              unit(random) * static_cast<float>(height)};
            const float a = smallest * std::pow(largest / smallest, unit(random));
            const float b = smallest * std::pow(largest / smallest, unit(random));
            const float angle = 3.14159265f * unit(random), c = std::cos(angle), s = std::sin(angle);
            const float opacity = 0.02f + (largest_opacity - 0.02f) * unit(random);
            d.mean.push_back(mean);
            d.conic_opacity.push_back({c * c / (a * a) + s * s / (b * b), c * s * (1 / (a * a) - 1 / (b * b)),
                                       s * s / (a * a) + c * c / (b * b), opacity});
            for (int k = 0; k < Channels; ++k) d.color.push_back(unit(random));
            const float radius = reach * std::max(a, b);
            const auto tile_at = [](float at, unsigned tiles) {
                return static_cast<unsigned>(
                    std::clamp(at / static_cast<float>(tile), 0.0f, static_cast<float>(tiles)));
            };
            const unsigned x1 = std::min(tiles_x, tile_at(mean.x + radius, tiles_x) + 1);
            const unsigned y1 = std::min(tiles_y, tile_at(mean.y + radius, tiles_y) + 1);
            for (unsigned y = tile_at(mean.y - radius, tiles_y); y < y1; ++y)
                for (unsigned x = tile_at(mean.x - radius, tiles_x); x < x1; ++x)
                    of_tile[y * tiles_x + x].push_back(i);
        }
        for (const auto& of : of_tile) {
            const auto first = static_cast<unsigned>(d.list.size());
            d.list.insert(d.list.end(), of.begin(), of.end());
            d.range.push_back({first, static_cast<unsigned>(d.list.size())});
        }
        for (std::size_t i = 0; i < std::size_t{Channels} * width * height; ++i)
            d.pixel_grad.push_back(unit(random) - 0.5f);
        return d;
    }

    scene(unsigned gaussians, unsigned width, unsigned height, const drawn& d)
        : mean_(d.mean),
          conic_opacity_(d.conic_opacity),
          color_(d.color),
          pixel_grad_(d.pixel_grad),
          list_(d.list),
          range_(d.range),
          transmittance_(std::size_t{width} * height),
          last_(std::size_t{width} * height),
          grad_(gaussians * std::size_t{record + 8 + Channels}),
          grid_((width + tile - 1) / tile, (height + tile - 1) / tile),
          frame_{width,
                 height,
                 grid_.x,
                 mean_.data(),
                 conic_opacity_.data(),
                 color_.data(),
                 list_.data(),
                 range_.data(),
                 transmittance_.data(),
                 last_.data(),
                 pixel_grad_.data()} {
        forward<<<grid_, dim3(tile, tile)>>>(frame_);
        check(cudaGetLastError());
        float* at = grad_.data();  // the largest alignment first
        record_ = at;
        arrays_.conic = reinterpret_cast<float4*>(at += gaussians * std::size_t{record});
        arrays_.mean = reinterpret_cast<float3*>(at += gaussians * std::size_t{4});
        arrays_.opacity = at += gaussians * std::size_t{3};
        arrays_.color = at + gaussians;
        device_array<unsigned long long> steps(2);
        run(count_steps{steps.data()});
        const auto counts = steps.to_host();
        idle_share_ = static_cast<double>(counts[1]) / static_cast<double>(counts[0]);
    }

    kernel_case prepared(const char* kernel, const char* input) const {
        float* const grad = grad_.data();
        const std::size_t size = grad_.size();
        return {kernel + (", N = " + std::to_string(N)),
                input,
                {},
                [=] { check(cudaMemset(grad, 0, size * sizeof(float))); },
                [=] {
                    std::vector<float> all(size);
                    check(cudaMemcpy(all.data(), grad, size * sizeof(float), cudaMemcpyDeviceToHost));
                    return all;
                },
                1e-3,
                idle_share_};
    }
    template <class Add>
    void run(Add add) const {
        backward<Channels><<<grid_, dim3(tile, tile)>>>(frame_, add);
    }

    static constexpr int N = 6 + Channels, record = (N + 3) / 4 * 4;
    device_array<float2> mean_;
    device_array<float4> conic_opacity_;
    device_array<float> color_, pixel_grad_;
    device_array<unsigned> list_;
    device_array<uint2> range_;
    device_array<float> transmittance_;
    device_array<unsigned> last_;
    device_array<float> grad_;
    dim3 grid_;
    frame frame_;
    float* record_ = nullptr;
    gradient_arrays<Channels> arrays_{};
    double idle_share_ = 0;
};

template <int Channels>
kernel_case scene<Channels>::with_arrays(std::shared_ptr<const scene> in, const char* input) {
    kernel_case of = in->prepared("blending backward, 4 arrays", input);
    of.variants.push_back({"plain atomics", [in] { in->run(plain_atomics<N>{in->arrays_}); }});
    const auto add = [&]<class Policy>(const char* name, Policy) {
        of.variants.push_back({name, [in] { in->run(to_arrays<Policy, N>{in->arrays_}); }});
    };
    add("default", policy<>{});
    add("shfl_down, scalar", policy<reduce::shfl_down, commit::scalar>{});
    add("scatter", policy<reduce::scatter>{});
    add("scatter, at_least<4>", policy<reduce::scatter, gate::at_least<4>>{});
    add("scatter, at_least<8>", policy<reduce::scatter, gate::at_least<8>>{});
    add("butterfly", policy<reduce::butterfly>{});
    return of;
}

template <int Channels>
kernel_case scene<Channels>::with_record(std::shared_ptr<const scene> in, const char* input) {
    kernel_case of = in->prepared("blending backward, 1 record", input);
    const auto add = [&]<class Policy>(const char* name, Policy) {
        of.variants.push_back({name, [in] { in->run(to_record<Policy, N>{in->record_}); }});
    };
    add("plain atomics", policy<reduce::per_lane>{});
    add("default", policy<>{});
    add("shfl_down, scalar", policy<reduce::shfl_down, commit::scalar>{});
    add("shfl_down, packed<4>", policy<reduce::shfl_down, commit::packed<4>>{});
    add("scatter", policy<reduce::scatter>{});
    add("scatter, at_least<4>", policy<reduce::scatter, gate::at_least<4>>{});
    add("scatter, at_least<16>", policy<reduce::scatter, gate::at_least<16>>{});
    add("butterfly", policy<reduce::butterfly>{});
    return of;
}

template <int Channels>
void add_cases(std::vector<kernel_maker>& to) {
    struct input {
        const char* name;
        unsigned gaussians, width, height;
        float smallest, largest, opacity, reach;
    };
    constexpr input inputs[] = {
        {"small Gaussians", 1000000, 800, 800, 0.3f, 1.0f, 1.0f, 4},
        {"large Gaussians", 200000, 1024, 1024, 1.0f, 12.0f, 0.5f, 3},
        {"Gaussians larger than a tile", 2000, 800, 800, 40.0f, 80.0f, 0.05f, 1},
    };
    for (const input& i : inputs) {
        const auto make = [i] {
            return std::make_shared<const scene<Channels>>(i.gaussians, i.width, i.height, i.smallest,
                                                           i.largest, i.opacity, i.reach);
        };
        to.push_back([=] { return scene<Channels>::with_arrays(make(), i.name); });
        to.push_back([=] { return scene<Channels>::with_record(make(), i.name); });
    }
}

}  // namespace

std::vector<kernel_maker> blending_cases() {
    std::vector<kernel_maker> all;
    add_cases<3>(all);
    add_cases<10>(all);
    add_cases<32>(all);
    return all;
}
