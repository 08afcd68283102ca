// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "../timetable.hpp"
#include "adaptive_config.hpp"
#include "densify_config.hpp"

namespace gs::train {

/// The timetable of the strategy `adaptive` (Kerbl et al. 2023, section 5.2).
class adaptive_schedule final : public timetable {
  public:
    adaptive_schedule(const adaptive_config& config, const training_facts& facts)
        : config_(config), facts_(facts) {}

    bool wants(int iteration) const override {
        return iteration < densify_until() || iteration <= prune_after();
    }
    bool due(int iteration) const override { return densifies(iteration) || prunes(iteration); }
    int count_is_final_after() const override;

    bool densifies(int iteration) const;
    /// Returns the first iteration without densification: see `default_growth_end`.
    int densify_until() const;
    /// Returns the thresholds of the densification in this iteration, which has `gaussians`
    /// Gaussians. A budget spreads the missing Gaussians evenly over the remaining densifications.
    densify_config densify_config_at(int iteration, std::size_t gaussians) const;
    /// Returns the mean gradient of its center, in halves of the image, from which a Gaussian
    /// grows. The default is 8e-5 if densification lasts 15,000 iterations. If it is shorter, the
    /// default is larger by the fourth root of the ratio, because a short training has no time for
    /// many Gaussians. Photos of more than 600,000 pixels raise the default by the root of that
    /// ratio, at most to its double: their finest details cost many Gaussians and gain little.
    double growth_threshold() const;
    /// Returns the number of densifications from this iteration on. Precondition: it is not after
    /// the last one.
    int densifications_from(int iteration) const;

    /// Returns whether the share `share_to_prune` is removed after this iteration.
    bool prunes(int iteration) const { return iteration == prune_after(); }
    /// Returns the share of Gaussians to remove. The default is a fifth if densification adds
    /// Gaussians without a budget and ends before training does. If photos have transparent parts,
    /// more than 3,500 iterations after densification raise it, to at most 0.6: the remaining
    /// Gaussians then have the time to take over. Source: measurements of lego.
    double share_to_prune() const;
    std::size_t number_to_prune(std::size_t gaussians) const {
        return static_cast<std::size_t>(share_to_prune() * static_cast<double>(gaussians));
    }
    /// Returns the iteration at which each training view was used about once since the last
    /// densification, or 0 for never.
    int prune_after() const;

    /// Returns whether opacities are reset: at each interval, but not in the last interval of
    /// densification, because opacities need time to recover. On a white background also when
    /// densification begins.
    bool resets_opacity(int iteration) const;
    /// Returns the weight of the mean opacity. The default is 0.25 divided by the number of training
    /// views, at most 0.01, because many views correct floaters themselves. It is 0 if photos have
    /// transparent parts: they show where the scene is empty.
    double opacity_penalty() const {
        const double by_views = std::min(0.01, 0.25 / std::max(1, facts_.views));
        return config_.opacity_penalty.value_or(facts_.transparent ? 0 : by_views);
    }
    /// Returns whether Gaussians near a camera are hidden: at each densification interval until the
    /// end.
    bool hides_near_cameras(int iteration) const {
        return iteration % config_.densification_interval == 0 || iteration == facts_.iterations.last();
    }

  private:
    adaptive_config config_;
    training_facts facts_;
};

}  // namespace gs::train
