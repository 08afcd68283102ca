// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "engine/engine.hpp"
#include "readers/load_scene.hpp"
#include "training/schedule.hpp"

/// What tests of the engine begin with.

using make_engine = std::unique_ptr<gs::train::engine> (*)();

/// The engines of this machine.
inline std::vector<make_engine> engines() {
    std::vector<make_engine> all{gs::train::make_cpu_engine};
#if defined(WARPAGG_TEST_CUDA)
    all.push_back(gs::train::make_cuda_engine);
#endif
    return all;
}

/// Square, with held-out views.
inline gs::scene small_scene(const char* name = "synthetic:spheres", int side = 48) {
    gs::load_options o;
    o.data = name;
    o.resolution = side;
    o.eval = true;
    return gs::load_scene(o, [](const std::string&) {});
}

/// A first step on this view, as training would make it.
inline gs::train::step_plan plan_for(std::size_t view) {
    gs::train::schedule s;
    gs::train::step_plan p;
    p.view = view;
    p.rates = s.rates_at(1);
    return p;
}

/// Densifies once, by what steps have collected, up to `cap` Gaussians. The strategy is `adaptive`: Gaussians
/// larger than a hundredth of `extent` are split.
inline gs::train::densify_report densify_once(gs::train::engine& e, gs::train::adaptive_config config,
                                              std::size_t cap, double extent = 1) {
    config.densify_from_iter = 0;
    config.densification_interval = 1;
    e.set_strategy({.adaptive = config}, {.extent = extent, .max_gaussians = cap});
    return e.densify(1);
}

/// Removes this share of the Gaussians, by what steps have collected.
inline void prune_once(gs::train::engine& e, double share) {
    gs::train::adaptive_config config;
    config.densify_until_iter = 0;
    config.prune_share = share;
    e.set_strategy({.adaptive = config}, {});
    e.densify(1);
}
