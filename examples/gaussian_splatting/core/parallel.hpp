// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <type_traits>
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

/// Makes `values` hold `count` zeros. All threads touch the new memory first, because Linux provides
/// and clears a page when it is first written, which takes one thread longer than reading a file of
/// this size.
template <class T>
void assign_zeros(std::vector<T>& values, std::size_t count) {
    static_assert(std::is_trivial_v<T>);
    constexpr std::size_t page = 4096, at_once = 512 * page;
    values.clear();
    values.reserve(count);
    volatile char* const memory = reinterpret_cast<char*>(values.data());
    const std::size_t bytes = count * sizeof(T);
    for_each_in_parallel((bytes + at_once - 1) / at_once, [&](std::size_t part) {
        const std::size_t end = std::min(bytes, (part + 1) * at_once);
        for (std::size_t i = part * at_once; i < end; i += page) memory[i] = 0;
    });
    values.resize(count);
}

}  // namespace gs
