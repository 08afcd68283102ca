// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/engine.hpp"
#include "engine/sh_degree_state.hpp"
#include "readers/load_scene.hpp"
#include "training/schedule.hpp"

/// The setup of tests of the engine.

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
    p.iteration = 1;
    p.view = view;
    p.rates = s.rates_at(1);
    return p;
}

/// A training run with these sums of gradients, without a penalty on opacities, which also changes Gaussians
/// that no view shows. Otherwise it has the defaults.
inline gs::train::training_setup setup_with(gs::accumulator sums) {
    gs::train::training_setup setup;
    setup.facts.gradient = sums;
    setup.densification.of<gs::train::adaptive_config>().opacity_penalty = 0;
    return setup;
}

inline gs::train::sh_degree_state& sh_of(gs::train::engine& e) {
    return dynamic_cast<gs::train::sh_degree_state&>(e.feature("direction"));
}

/// Densifies once, by what steps have collected, up to `cap` Gaussians. The strategy is `adaptive`: Gaussians
/// larger than a hundredth of `extent` are split.
/// Returns the number of Gaussians that were drawn and received no gradient.
inline std::uint64_t densify_once(gs::train::engine& e, gs::train::adaptive_config config, std::size_t cap,
                                  double extent = 1) {
    config.densify_from_iter = 0;
    config.densification_interval = 1;
    config.opacity_penalty = config.opacity_penalty.value_or(0);
    gs::train::training_setup setup;
    setup.facts.extent = extent;
    setup.facts.max_gaussians = cap;
    setup.densification.of<gs::train::adaptive_config>() = config;
    e.begin(setup);
    return e.densify(1);
}

/// Removes this share of the Gaussians, by what steps have collected.
inline void prune_once(gs::train::engine& e, double share) {
    gs::train::training_setup setup;
    setup.densification.of<gs::train::adaptive_config>().densify_until_iter = 0;
    setup.densification.of<gs::train::adaptive_config>().prune_share = share;
    e.begin(setup);
    e.densify(1);
}
