// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <vector>

namespace gs {

/// Calls `body(i)` for each i in [0, count), in parallel. If calls throw, rethrows the exception of
/// the lowest i, so that the result does not depend on the number of threads.
template <class Body>
void for_each_in_parallel(std::size_t count, const Body& body) {
    std::vector<std::exception_ptr> failures(count);
    std::atomic<std::size_t> lowest_failed{count};
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (std::size_t i = 0; i < count; ++i) {
        if (i > lowest_failed.load()) continue;
        try {
            body(i);
        } catch (...) {
            failures[i] = std::current_exception();
            std::size_t lowest = lowest_failed.load();
            while (i < lowest && !lowest_failed.compare_exchange_weak(lowest, i)) {
            }
        }
    }
    if (lowest_failed < count) std::rethrow_exception(failures[lowest_failed]);
}

}  // namespace gs
