// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "../strategy.hpp"
#include "growth_kernels.hpp"

namespace gs::train {

/// Limits and manner of one growth.
struct growth_limits {
    std::size_t cap = 0;  ///< largest number of Gaussians to which the model grows
    /// Largest number of new Gaussians. The most urgent ones grow first.
    std::size_t most_births = std::numeric_limits<std::size_t>::max();
    /// Makes a Gaussian and its clone together as opaque as the Gaussian was (Rota Bulo et al.
    /// 2024).
    bool revised_opacity = true;
};

/// Replaces the Gaussians in training with a new generation. Call `begin`, fill the marks with a
/// kernel of the strategy, then call `grow` or `remove`. Both wait for the device once.
template <device::device Device>
class growth {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using context = run_context<Device>;

  public:
    explicit growth(Device& device) : device_(device) { tally_.resize(1); }

    /// Returns the marks of `c.count` Gaussians. Only the counters are initialized.
    growth_marks begin(const context& c) {
        for (auto* b : {&copies_, &large_, &key_, &gaussian_of_}) b->resize(c.count);
        first_copy_.resize(c.count + 1);
        device_.zero(tally_.data(), 1);
        return {copies_.data(), large_.data(), key_.data(), gaussian_of_.data(),
                &tally_.data()->without_gradient};
    }

    /// Clones and splits the Gaussians with the smallest keys, and removes those that do not stay.
    growth_tally grow(const context& c, const growth_limits& limits) {
        c.gather.reserve(std::min(2 * c.count, std::max(c.count, limits.cap)));
        device_.prefix_sum(copies_, first_copy_, c.count);
        device_.sort_pairs(key_, gaussian_of_, c.count);
        device_.for_each_index(
            c.count, select_growth{key_.data(), gaussian_of_.data(), first_copy_.data() + c.count, limits.cap,
                                   limits.most_births, copies_.data()});
        const growth_tally tally = renew(c);
        const auto gaussians = c.parameters.values.write();
        device_.for_each_index(tally.count, split{c.gather.births(), c.gather.origins(), gaussians});
        if (limits.revised_opacity)
            device_.for_each_index(tally.count, revise_opacity{c.gather.births(), gaussians.opacity});
        return tally;
    }

    /// Removes the `removed` Gaussians with the smallest keys.
    growth_tally remove(const context& c, std::size_t removed) {
        c.gather.reserve(c.count);
        device_.sort_pairs(key_, gaussian_of_, c.count);
        device_.for_each_index(removed, clear_ranked{gaussian_of_.data(), copies_.data()});
        return renew(c);
    }

  private:
    /// Starts a new generation with `copies_[i]` successors of Gaussian i.
    growth_tally renew(const context& c) {
        device_.prefix_sum(copies_, first_copy_, c.count);
        device_.for_each_index(c.count, place_copies{copies_.data(), large_.data(), first_copy_.data(),
                                                     c.gather.origins(), c.gather.births()});
        device_.copy(&tally_.data()->count, first_copy_.data() + c.count, 1);
        growth_tally tally;
        device_.download(&tally, tally_.data(), 1);
        c.gather.run(c.parameters, tally.count, tally.count, c.sh_degree);
        return tally;
    }

    Device& device_;
    buffer<std::uint32_t> copies_, large_, key_, gaussian_of_;
    buffer<std::uint64_t> first_copy_;
    buffer<growth_tally> tally_;
};

}  // namespace gs::train
