// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "lab/accumulator_set.hpp"
#include "measure.hpp"
#include "model/parameter_memory.hpp"
#include "render/renderer.hpp"
#include "warps.hpp"

namespace gs::lab {

/// Measures the backward blending on a device.
template <class Device>
class paper_bench {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using cut = gs::raster::cut_for<typename Device::warp>;

  public:
    explicit paper_bench(const paper_subject& s) : subject_(s), renderer_(device_) {
        model_.upload(device_, s.model);
        std::mt19937_64 random(s.seed);
        std::normal_distribution<float> normal;
        std::size_t pixels = 0;
        for (const gs::camera& view : s.cameras)
            pixels = std::max(pixels,
                              static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
        std::vector<float> gradient(3 * pixels);
        for (float& g : gradient) g = normal(random);
        for (const float g : gradient) largest_ = std::max(largest_, std::abs(g));
        gradient_.resize(gradient.size());
        device_.upload(gradient_.data(), gradient.data(), gradient.size());
        std::uint64_t most = 0;
        for (const gs::camera& view : s.cameras) {
            renderer_.measure(model_.read(), s.model.count(), view, 0);
            most = std::max(most, renderer_.instances());
        }
        renderer_.reserve_instances(most);
    }

    std::string device_name() { return device_.name(); }

    /// The paper's rungs of the ladder, and the original without atomics.
    std::vector<paper_kernel> kernels() {
        for (const auto how : {gs::lab::per_lane, gs::lab::reduce, gs::lab::reduce_skip, gs::lab::native})
            gs::lab::lab_accumulators::with_kernel<float, cut>(
                how, [&](auto kernel) { enter(std::string(gs::lab::name_of(how)), kernel); });
        enter("plain adds", with_plain_adds<original>{});
        compare();
        for (int round = -1; round < subject_.rounds; ++round)  // the first warms up
            for (std::size_t i = 0; i < frames_.size(); ++i) {
                device_.sample_times(1);
                for (const gs::camera& view : subject_.cameras) {
                    frames_[i](view);
                    device_.end_iteration();
                }
                const auto times = device_.times();
                constexpr auto backward = static_cast<std::size_t>(gs::device::stage::blend_backward);
                if (round >= 0)
                    kernels_[i].milliseconds.push_back(times.milliseconds[backward] / times.sampled);
            }
        return kernels_;
    }

    active_lanes active() {
        static_assert(Device::warp::size == 32);
        active_lanes result;
        buffer<unsigned long long> counts;
        counts.resize(result.warps.size());
        device_.zero(counts.data(), counts.size());
        for (const gs::camera& view : subject_.cameras) {
            run(with_counts<original>{{}, counts.data()}, view);
            result.listed += renderer_.instances() * (gs::raster::tile_size * gs::raster::tile_size / 32);
        }
        device_.download(result.warps.data(), counts.data(), counts.size());
        return result;
    }

  private:
    using original = gs::lab::per_lane_sums::kernel<float, cut>;

    template <class Kernel>
    const buffer<float>& run(const Kernel& kernel, const gs::camera& view) {
        renderer_.forward(model_.read(), subject_.model.count(), view, subject_.model.sh_degree,
                          subject_.background);
        return renderer_.blend_backward_by(kernel, gradient_.data(), largest_);
    }
    template <class Kernel>
    void enter(const std::string& name, const Kernel& kernel) {
        kernels_.push_back({name, {}, 0});
        frames_.push_back(
            [this, kernel](const gs::camera& view) -> const buffer<float>& { return run(kernel, view); });
    }
    void compare() {
        std::vector<float> first;
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            const auto& sums = frames_[i](subject_.cameras.front());
            std::vector<float> mine(sums.size());
            device_.download(mine.data(), sums.data(), mine.size());
            if (i == 0) first = mine;
            double apart = 0, norm = 0;
            for (std::size_t k = 0; k < mine.size(); ++k) {
                if (k % gs::raster::record_stride >= gs::raster::sum_count) continue;  // of no meaning
                apart += std::pow(double{mine[k]} - first[k], 2);
                norm += std::pow(double{first[k]}, 2);
            }
            kernels_[i].apart = std::sqrt(apart / norm);
        }
    }

    const paper_subject& subject_;
    Device device_;
    gs::raster::renderer<Device, float> renderer_;
    gs::parameter_memory<Device> model_;
    buffer<float> gradient_;
    float largest_ = 0;  ///< of it
    std::vector<paper_kernel> kernels_;
    std::vector<std::function<const buffer<float>&(const gs::camera&)>> frames_;
};

}  // namespace gs::lab
