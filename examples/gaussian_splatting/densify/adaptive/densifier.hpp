// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../strategy.hpp"
#include "densify_kernels.hpp"

namespace gs::train {

/// Replaces the Gaussians in training with a new generation, based on the statistics of their
/// gradients.
template <device::device Device>
class densifier {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using context = run_context<Device>;

  public:
    explicit densifier(Device& device) : device_(device) { tally_.resize(1); }

    /// Clones, splits and removes Gaussians as `config` specifies. Waits for the device once.
    densify_tally densify(const context& c, const densify_config& config) {
        begin(c, std::min(2 * c.count, std::max<std::size_t>(c.count, config.cap)));
        device_.for_each_index(
            c.count, classify{c.parameters.values.read(), c.statistics, config, copies_.data(), large_.data(),
                              urgency_.data(), gaussian_of_.data(), &tally_.data()->without_gradient});
        device_.prefix_sum(copies_, first_copy_, c.count);
        device_.sort_pairs(urgency_, gaussian_of_, c.count);
        device_.for_each_index(
            c.count, select_growth{urgency_.data(), gaussian_of_.data(), first_copy_.data() + c.count,
                                   config.cap, config.most_births, copies_.data()});
        const densify_tally tally = renew(c);
        const auto gaussians = c.parameters.values.write();
        device_.for_each_index(tally.count, split{c.gather.births(), config.seed, config.step, gaussians});
        if (config.revised_opacity)
            device_.for_each_index(tally.count, revise_opacity{c.gather.births(), gaussians.opacity});
        return tally;
    }

    /// Removes the `removed` Gaussians with the smallest sums of gradients. Waits for the device
    /// once.
    void prune(const context& c, std::size_t removed) {
        begin(c, c.count);
        device_.for_each_index(
            c.count, rate_by_gradient{c.statistics, copies_.data(), urgency_.data(), gaussian_of_.data()});
        device_.sort_pairs(urgency_, gaussian_of_, c.count);
        device_.for_each_index(removed, clear_ranked{gaussian_of_.data(), copies_.data()});
        renew(c);
    }

  private:
    void begin(const context& c, std::size_t most) {
        for (auto* b : {&copies_, &large_, &urgency_, &gaussian_of_}) b->resize(c.count);
        c.gather.reserve(most);
        first_copy_.resize(c.count + 1);
        device_.zero(tally_.data(), 1);
    }

    /// Starts a new generation with `copies_[i]` successors of Gaussian i.
    densify_tally renew(const context& c) {
        device_.prefix_sum(copies_, first_copy_, c.count);
        device_.for_each_index(c.count, place_copies{copies_.data(), large_.data(), first_copy_.data(),
                                                     c.gather.origins(), c.gather.births()});
        device_.copy(&tally_.data()->count, first_copy_.data() + c.count, 1);
        densify_tally tally;
        device_.download(&tally, tally_.data(), 1);
        c.gather.run(c.parameters, tally.count, tally.count, c.sh_degree);
        return tally;
    }

    Device& device_;
    buffer<std::uint32_t> copies_, large_, urgency_, gaussian_of_;
    buffer<std::uint64_t> first_copy_;
    buffer<densify_tally> tally_;
};

}  // namespace gs::train
