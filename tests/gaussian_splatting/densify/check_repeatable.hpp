// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <omp.h>

#include <cstddef>

#include "../hard_cases/budget.hpp"
#include "../training/check_equal.hpp"
#include "../training/engines.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

/// Checks that training 300 Gaussians with `o`, on each engine and with any number of threads, gives
/// the same model bit for bit. Returns its number of Gaussians.
inline std::size_t check_repeatable(const gs::scene& scene, const gs::train::train_options& o) {
    const gs::gaussians model = gs::from_points(scene.points, 1, 300, 1);
    const auto trained = [&](gs::train::engine& e) {
        e.set_views(scene.train, {}, o.schedule.num_downscales);
        e.set_model(model);
        gs::train::train(e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
        return e.get_model();
    };
    const int threads = omp_get_max_threads();
    std::size_t count = 0;
    for (const auto make : engines()) {
        const gs::gaussians first = trained(*make());
        count = first.count();
        for (const int n : {1, 3}) {
            if (n > 1 && hard_cases::brief) continue;
            omp_set_num_threads(n);
            check_equal(trained(*make()), first);
        }
        omp_set_num_threads(threads);
    }
    return count;
}
