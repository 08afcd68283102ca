// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "check_settings.hpp"

#include "../core/error.hpp"
#include "../densify/adaptive/adaptive_schedule.hpp"

namespace gs::cli {

namespace {

void check_iterations(const std::set<int>& iterations, int last, const std::string& option) {
    if (!iterations.empty() && *iterations.rbegin() > last)
        throw error(option + " names iteration " + std::to_string(*iterations.rbegin()) +
                    ", but there are only iterations 1 to " + std::to_string(last) +
                    ": raise --iterations or leave it out");
}

void check_downscales(const train::schedule& plan) {
    const std::int64_t until = std::int64_t{plan.num_downscales} * plan.resolution_interval();
    if (plan.num_downscales > 0 && until >= plan.iterations)
        throw error("--num-downscales " + std::to_string(plan.num_downscales) +
                    " with --resolution-schedule " + std::to_string(plan.resolution_interval()) +
                    " trains on whole photos only after iteration " + std::to_string(until) +
                    ", but there are only " + std::to_string(plan.iterations) + ": lower one of them");
}

void check_pruning(const settings& s) {
    const train::adaptive_schedule plan(s.densification.adaptive, {.iterations = s.schedule.iterations});
    if (plan.share_to_prune() > 0 && plan.densify_until() >= s.schedule.iterations)
        throw error("--prune-share prunes after densification, which --densify-until-iter ends at " +
                    std::to_string(plan.densify_until()) + ", but there are only " +
                    std::to_string(s.schedule.iterations) +
                    " iterations: lower --densify-until-iter or set --prune-share 0");
}

void check_budget(const settings& s) {
    if (s.budget && s.max_cap && *s.budget > *s.max_cap)
        throw error("--budget " + std::to_string(*s.budget) + " is more than --max-cap " +
                    std::to_string(*s.max_cap) + ": lower the budget or raise the cap");
}

void check_background(const settings& s) {
    if (s.command != command::train && s.background == background_kind::random)
        throw error("--background random is for train: give " + name_of(s.command) + " white or black");
}

}  // namespace

void set_dependent_values(settings& s) {
    s.scene.seed = s.seed;
    train::adaptive_config& adaptive = s.densification.adaptive;
    adaptive.budget = s.budget.value_or(0);
    if (s.budget && !adaptive.prune_share) adaptive.prune_share = 0;
    if (s.command == command::train) {
        s.scene.masks = s.effects.allows("masks");
        s.scene.depths = s.effects.allows("depth");
    }
    if (s.command == command::render) s.scene.masks = false;  // renders do not depend on photos
    if (s.command == command::render || s.command == command::evaluate) s.scene.depths = false;
}

void check_settings(const settings& s) {
    check_iterations(s.save_iterations, s.schedule.iterations, "--save-iterations");
    check_iterations(s.test_iterations, s.schedule.iterations, "--test-iterations");
    check_downscales(s.schedule);
    check_pruning(s);
    check_budget(s);
    check_background(s);
}

}  // namespace gs::cli
