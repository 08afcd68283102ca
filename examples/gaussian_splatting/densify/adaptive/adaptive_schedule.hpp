// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "../timetable.hpp"
#include "adaptive_config.hpp"
#include "densify_config.hpp"

namespace gs::train {

/// What the strategy `adaptive` does in which iteration (Kerbl et al. 2023, section 5.2).
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
    /// The first iteration that no longer densifies: by default half of the iterations, at most 15,000.
    int densify_until() const;
    /// Thresholds of the densification in this iteration, which has `gaussians` Gaussians. With a budget the
    /// missing Gaussians are spread evenly over the remaining densifications.
    densify_config densify_config_at(int iteration, std::size_t gaussians) const;
    /// A Gaussian grows from this mean gradient of its center, in halves of the image. By default 8e-5 if
    /// densification lasts 15,000 iterations, and larger by the fourth root if it is shorter: a short
    /// training has no time for many Gaussians.
    double growth_threshold() const;
    /// Number of densifications from this iteration on. Precondition: it is not after the last one.
    int densifications_from(int iteration) const;

    /// Whether the share `share_to_prune` is removed after this iteration.
    bool prunes(int iteration) const { return iteration == prune_after(); }
    /// By default a fifth if densification adds Gaussians without a budget and ends before training does.
    double share_to_prune() const;
    /// The iteration when each training view has been seen about once since the last densification; 0: never.
    int prune_after() const;

    /// Every interval, but not in the last interval of densification: opacities need time to recover. If
    /// images are shown on white, also when densification begins.
    bool resets_opacity(int iteration) const;
    /// Whether Gaussians near a camera are hidden: at each densification interval, to the end.
    bool hides_near_cameras(int iteration) const {
        return iteration % config_.densification_interval == 0 || iteration == facts_.iterations;
    }

  private:
    adaptive_config config_;
    training_facts facts_;
};

}  // namespace gs::train
