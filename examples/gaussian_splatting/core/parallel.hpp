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

/// Calls `body(i)` for each i in [0, count), in parallel and in blocks, for calls that take so little
/// time that handing out each of them would take longer. Throws like `for_each_in_parallel`.
template <class Body>
void for_each_index_in_parallel(std::size_t count, const Body& body) {
    constexpr std::size_t at_once = 4096;
    for_each_in_parallel((count + at_once - 1) / at_once, [&](std::size_t block) {
        const std::size_t end = std::min(count, (block + 1) * at_once);
        for (std::size_t i = block * at_once; i < end; ++i) body(i);
    });
}

/// Sorts in parallel. The result does not depend on the number of threads, but the order of equal
/// values is unspecified.
template <class T>
void sort_in_parallel(std::vector<T>& values) {
    constexpr std::size_t parts = 16;
    const auto begin_of = [&](std::size_t part) {
        return values.begin() + static_cast<std::ptrdiff_t>(part * values.size() / parts);
    };
    for_each_in_parallel(parts, [&](std::size_t i) { std::sort(begin_of(i), begin_of(i + 1)); });
    for (std::size_t sorted = 1; sorted < parts; sorted *= 2)
        for_each_in_parallel(parts / (2 * sorted), [&](std::size_t i) {
            const std::size_t first = 2 * i * sorted;
            std::inplace_merge(begin_of(first), begin_of(first + sorted), begin_of(first + 2 * sorted));
        });
}

/// Makes `values` hold `count` zeros. All threads write to the new memory first: Linux provides and
/// clears a page at the first write to it, and one thread takes long for that. The writes are to
/// reserved memory, before the vector's values begin to exist.
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
