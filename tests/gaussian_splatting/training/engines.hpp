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
    p.watch = true;
    return p;
}
