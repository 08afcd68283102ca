// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "lab/accumulator_set.hpp"
#include "model/parameter_memory.hpp"
#include "ranking.hpp"
#include "render/renderer.hpp"

namespace gs::lab {

/// Measures the variants on a device.
template <class Device>
class fixture {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit fixture(const ranking_setup& c) : setup_(c) {
        model_.upload(device_, c.model);
        const std::vector<float> gradient = render_gradient(c);
        for (const float g : gradient) largest_ = std::max(largest_, std::abs(g));
        gradient_.resize(gradient.size());
        device_.upload(gradient_.data(), gradient.data(), gradient.size());
        device_.wait();
    }

    /// The renderer whose view is cut up by `Cut`, with room for every view.
    template <class Cut>
    auto renderer() {
        auto r = std::make_shared<gs::raster::renderer<Device, float, Cut>>(device_);
        std::uint64_t most = 0;
        for (const gs::camera& view : setup_.cameras) {
            r->measure(model_.read(), setup_.model.count(), view, 0);
            most = std::max(most, r->instances());
        }
        r->reserve_instances(most);
        return r;
    }
    /// A variant: `kernel` after the forward blending of `renderer`.
    template <class Renderer, class Kernel>
    void enter(const std::string& name, bool rung, const std::shared_ptr<Renderer>& renderer, Kernel kernel) {
        standings_.push_back({name, rung, {}, {}, 0, 0, 0});
        frames_.push_back([this, renderer, kernel](const gs::camera& view) -> const buffer<float>& {
            renderer->forward(model_.read(), setup_.model.count(), view, setup_.model.sh_degree,
                              setup_.background);
            const auto& sums = renderer->blend_backward_by(kernel, gradient_.data(), largest_);
            device_.end_iteration();
            return sums;
        });
        pairs_.push_back([this, renderer] {
            unsigned long long n = 0;
            device_.download(&n, renderer->pairs(), 1);
            return static_cast<double>(n);
        });
    }
    /// The kernels of the ladder, or the ways of keeping the last one's sums.
    template <class Cut>
    void enter_ladder() {
        const auto r = renderer<Cut>();
        const auto enter_all = [&](const auto& named) {
            for (const auto& [name, how] : named)
                gs::lab::lab_accumulators::with_kernel<float, Cut>(
                    how, [&](auto kernel) { enter(std::string(name), true, r, kernel); });
        };
        setup_.compares_accumulations ? enter_all(gs::lab::accumulations) : enter_all(gs::lab::ladder);
    }
    template <class Cut>
    void enter_cut() {
        gs::raster::product_accumulators::with_kernel<float, Cut>(gs::accumulator::native, [&](auto kernel) {
            enter(std::to_string(Cut::across) + " across, " + std::to_string(Cut::rows) +
                      " a lane, segments of " + std::to_string(Cut::segment) +
                      (Cut::sparse ? ", row by row" : ""),
                  false, renderer<Cut>(), kernel);
        });
    }

    ranking measure() {
        compare();
        for (int round = -1; round < setup_.rounds; ++round)  // the first warms up
            for (std::size_t i = 0; i < frames_.size(); ++i) {
                const double before = pairs_[i]();
                device_.sample_times(1);
                for (const gs::camera& view : setup_.cameras) frames_[i](view);
                const auto times = device_.times();
                if (round < 0) continue;
                const auto ms = [&](gs::device::stage s) {
                    return times.milliseconds[static_cast<std::size_t>(s)] / times.sampled;
                };
                standings_[i].forward.push_back(ms(gs::device::stage::blend_forward));
                standings_[i].backward.push_back(ms(gs::device::stage::blend_backward));
                standings_[i].pairs = (pairs_[i]() - before) / static_cast<double>(setup_.cameras.size());
            }
        return {device_.name(), 1, standings_};
    }

  private:
    /// Every variant's sums beside the first one's, and beside those in double, in a few views.
    void compare() {
        for (std::size_t v = 0; v < compared_views(setup_); ++v) {
            std::vector<double> first;
            for (std::size_t i = 0; i < frames_.size(); ++i) {
                const auto& sums = frames_[i](setup_.cameras[v]);
                std::vector<float> mine(sums.size());
                device_.download(mine.data(), sums.data(), mine.size());
                if (i == 0) first.assign(mine.begin(), mine.end());
                standing& s = standings_[i];
                s.apart = std::max(s.apart, distance(mine, first));
                if (!setup_.reference_fp64.empty())
                    s.error = std::max(s.error, distance(mine, setup_.reference_fp64[v]));
            }
        }
    }
    static double distance(const std::vector<float>& sums, const std::vector<double>& from) {
        double apart = 0, norm = 0;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            if (k % gs::raster::record_stride >= gs::raster::sum_count) continue;  // of no meaning
            apart += std::pow(double{sums[k]} - from[k], 2);
            norm += std::pow(from[k], 2);
        }
        return std::sqrt(apart / norm);
    }

    const ranking_setup& setup_;
    Device device_;
    gs::parameter_memory<Device> model_;
    buffer<float> gradient_;
    float largest_ = 0;  ///< of it
    std::vector<standing> standings_;
    std::vector<std::function<const buffer<float>&(const gs::camera&)>> frames_;
    std::vector<std::function<double()>> pairs_;
};

}  // namespace gs::lab
