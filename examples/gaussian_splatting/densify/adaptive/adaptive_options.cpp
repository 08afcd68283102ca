// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../../core/error.hpp"
#include "../../options/option.hpp"
#include "adaptive_schedule.hpp"

namespace gs::train {

using namespace options;

namespace {

/// When Gaussians are added and removed.
std::vector<option> timing_options(adaptive_config& c) {
    return {{.names = "--densify-from-iter",
             .value = whole(c.densify_from_iter, 0, most_iterations),
             .help = "Last iteration before densification begins",
             .unit = "iterations"},
            {.names = "--densify-until-iter",
             .value = whole(c.densify_until_iter, 0, most_iterations),
             .help = "Iteration that ends densification",
             .unit = "iterations",
             .default_text =
                 "half of the iterations, at most 15000; without transparent parts of photos, at most "
                 "the larger of 3500 and 40 for each photo"},
            {.names = "--densification-interval",
             .value = whole(c.densification_interval, 1, most_iterations),
             .help = "Iterations between two densification steps",
             .unit = "iterations"},
            {.names = "--opacity-reset-interval",
             .value = whole(c.opacity_reset_interval, 1, most_iterations),
             .help = "Iterations between two opacity resets; the last interval of densification has none; on "
                     "a white background densification begins with one",
             .unit = "iterations"}};
}

/// Which Gaussians are added and removed.
std::vector<option> growth_options(adaptive_config& c) {
    return {
        {.names = "--densify-grad-threshold",
         .value = positive(c.densify_grad_threshold),
         .help = "Mean gradient of a Gaussian's projected center above which the Gaussian grows, in units "
                 "of half the image size",
         .default_text = "8e-5 if densification ends at iteration 15000; higher if it ends earlier or photos "
                         "have more than 600000 pixels"},
        {.names = "--budget",
         .value = whole(c.budget, 1, 300000000),
         .help = "Number of Gaussians that densification grows to in even steps, whatever the gradients "
                 "(Mallick et al. 2024)",
         .unit = "Gaussians",
         .default_text = "none; gradients decide",
         .excludes = {"--densify-grad-threshold"}},
        {.names = "--revised-opacity,!--no-revised-opacity",
         .value = flag(c.revised_opacity),
         .help = "Lowers the opacities of a Gaussian and its new copy, so that together they are as "
                 "opaque as the Gaussian was (Rota Bulò et al. 2024)"},
        {.names = "--opacity-penalty",
         .value = not_negative(c.opacity_penalty),
         .help = "Weight of the mean opacity beside the loss; reduces floaters",
         .default_text = "0.25 / photos, at most 0.01; 0 if they have transparent parts"},
        {.names = "--prune-share",
         .value = share(c.prune_share),
         .help = "Share of the Gaussians that is removed after densification, those with the smallest "
                 "accumulated positional gradient first",
         .default_text = "0.2, or up to 0.6 in long runs if photos have transparent parts; 0 with --budget"}};
}

}  // namespace

std::vector<option> adaptive_config::options() {
    std::vector<option> all = timing_options(*this);
    for (option& row : growth_options(*this)) all.push_back(std::move(row));
    return all;
}

void adaptive_config::check(const training_facts& facts) const {
    const adaptive_schedule schedule(*this, facts);
    if (schedule.share_to_prune() > 0 && schedule.densify_until() >= facts.iterations.last())
        throw error("--prune-share prunes after densification, which --densify-until-iter ends at " +
                    std::to_string(schedule.densify_until()) + ", but there are only " +
                    std::to_string(facts.iterations.last()) +
                    " iterations: lower --densify-until-iter or set --prune-share 0");
    if (facts.max_gaussians > 0 && budget.value_or(0) > facts.max_gaussians)
        throw error("--budget " + std::to_string(*budget) + " is more than --max-cap " +
                    std::to_string(facts.max_gaussians) + ": lower the budget or raise the cap");
}

adaptive_config adaptive_config::resolved(const training_facts& facts) const {
    const adaptive_schedule schedule(*this, facts);
    adaptive_config all = *this;
    all.densify_until_iter = schedule.densify_until();
    all.densify_grad_threshold = schedule.growth_threshold();
    all.opacity_penalty = schedule.opacity_penalty();
    all.prune_share = schedule.share_to_prune();
    return all;
}

}  // namespace gs::train
