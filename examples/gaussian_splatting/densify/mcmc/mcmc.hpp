// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../hide_near_camera.hpp"
#include "../penalties.hpp"
#include "../strategy.hpp"
#include "mcmc_config.hpp"
#include "mcmc_kernels.hpp"

namespace gs::train {

/// Densification as Markov chain Monte Carlo (Kheradmand et al. 2024). Noise moves transparent
/// Gaussians, penalties make unneeded ones transparent, and at intervals dead Gaussians move to
/// opaque ones. The number of Gaussians grows by a constant factor, reaches the limit in the last run,
/// and never shrinks.
///
/// Unlike in the paper, noise and scale penalty are relative to the extent of the scene, penalties do
/// not change Adam's moments, and one draw finds the origins of dead and of new Gaussians.
template <device::device Device>
class mcmc final : public strategy<Device> {
  public:
    using settings = mcmc_config;

    mcmc(Device& device, const mcmc_config& config, const training_facts& facts)
        : device_(device), config_(config), facts_(facts) {}

    bool wants(int) const override { return false; }
    bool due(int iteration) const override {
        return iteration > first() && iteration % interval == 0 && iteration <= count_is_final_after();
    }
    int count_is_final_after() const override { return facts_.iterations.milestone(5.0 / 6); }

    void after_step(int iteration, const step_context<Device>& c) override {
        if (is_last(iteration)) return;  // the result has no noise
        const double rate = c.rates[static_cast<std::size_t>(parameter::mean)];
        // Divided by the square of the extent, the noise does not depend on the unit of length.
        const double strength = config_.noise * rate / (facts_.extent * facts_.extent);
        device_.for_each_index(
            c.own, add_noise{c.parameters.values.write(), static_cast<float>(strength), facts_.seed,
                             static_cast<std::uint64_t>(iteration), c.capacity});
        apply_penalties({config_.opacity_penalty, config_.scale_penalty}, facts_.extent, iteration, c);
    }

    std::size_t memory_key(int iteration) const override { return is_last(iteration) ? 1 : 0; }

    densify_report run(int iteration, const run_context<Device>& c) override {
        for (auto* b : {&dead_, &weight_, &drawn_}) b->resize(c.count);
        weight_before_.resize(c.count + 1);
        device_.for_each_index(c.count, weigh_by_opacity{c.parameters.values.read().opacity, dead_.data(),
                                                         weight_.data(), drawn_.data()});
        device_.prefix_sum(weight_, weight_before_, c.count);
        std::uint64_t weight = 0;
        device_.download(&weight, weight_before_.data() + c.count, 1);
        if (weight == 0) return {c.count};  // nothing to copy
        const std::size_t count = std::max(c.count, std::min(grown(c.count, iteration), c.most));
        c.gather.reserve(count);
        device_.for_each_index(count, draw_origins{c.count, dead_.data(), weight_before_.data(), facts_.seed,
                                                   static_cast<std::uint64_t>(iteration), drawn_.data(),
                                                   c.gather.origins(), c.gather.births()});
        device_.for_each_index(c.count, forget_moments{drawn_.data(), c.gather.births()});
        c.gather.order_by_origin(count);
        c.gather.run(c.parameters, count, count, c.sh_degree);
        device_.for_each_index(
            count, share_appearance{c.gather.origins(), drawn_.data(), c.parameters.values.write()});
        return {count};
    }

    void adjust(int iteration, const trained_gaussians<Device>& g) override {
        if (iteration % interval == 0 || is_last(iteration)) hide_near_cameras(g);
    }

  private:
    static constexpr int interval = 100;

    bool is_last(int iteration) const { return iteration == facts_.iterations.last(); }
    /// Returns the last iteration before the first run.
    int first() const { return std::min(500, facts_.iterations.milestone(0.1)); }
    /// Returns the number of Gaussians after the run of this iteration.
    std::size_t grown(std::size_t count, int iteration) const {
        const int runs = std::max(1, count_is_final_after() / interval - (iteration - 1) / interval);
        const double now = static_cast<double>(count), most = static_cast<double>(facts_.max_gaussians);
        const auto more = static_cast<std::size_t>(std::ceil(now * std::pow(most / now, 1.0 / runs)));
        return std::max(count, std::min(more, facts_.max_gaussians));
    }

    Device& device_;
    mcmc_config config_;
    training_facts facts_;
    typename Device::template buffer<std::uint32_t> dead_, weight_, drawn_;
    typename Device::template buffer<std::uint64_t> weight_before_;
};

}  // namespace gs::train
