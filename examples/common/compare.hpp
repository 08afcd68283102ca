// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Runs an example's kernel with and without warpagg, checks its result, and prints what it took. The same
/// source is an example for the emulator when compiled as C++ and for the GPU when compiled as CUDA.

#if defined(__CUDACC__)
#include "cuda.hpp"
#else
#include "emulator.hpp"
#endif

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace example {

/// Runs the kernel with plain atomics and with warpagg, checks what each leaves in `result`, and prints a
/// line for each. `make(policy)` is the kernel: it has `lanes()`, how many lanes it wants, and `operator()(w,
/// first)`, which a warp `w` calls for its lanes, `first` and those that follow.
/// @throws std::runtime_error if `result` is not `expected` afterwards
template <class T, class Make>
void compare(const std::string& data, machine::array<T>& result, const std::vector<T>& expected,
             const Make& make) {
    const auto measure = [&](const char* name, const auto& kernel) {
        result.zero();
        const auto measured = machine::run(kernel);
        if (result.download() != expected) throw std::runtime_error(data + ", " + name + ": wrong sums");
        return measured;
    };
    const auto plain = make(warpagg::policy{warpagg::per_lane});
    const auto aggregated = make(warpagg::policy<>{});
    machine::measured one = measure("plain atomics", plain), other = measure("warpagg", aggregated);
    machine::time(result, plain, one, aggregated, other);

    const auto print = [&](const char* name, const machine::measured& m) {
        std::printf("| %-27s | %-13s | %9llu | %5.2fx | ", data.c_str(), name,
                    static_cast<unsigned long long>(m.atomics),
                    static_cast<double>(one.atomics) / static_cast<double>(m.atomics));
        machine::print_cost(one, m);
    };
    print("plain atomics", one);
    print("warpagg", other);
}

/// An example's `main`: `f(size)`, with the size from the command line if it is given there.
/// @returns the exit status
template <class F>
int run(const char* title, const char* unit, int argc, char** argv, const F& f) {
    constexpr unsigned long least = 1u << 10, most = 1u << 24;
    try {
        const auto size = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : machine::default_size;
        if (size < least || size > most)
            throw std::invalid_argument("the size is a number from 1024 to 16777216");
        std::printf("%s: %lu %s, on %s\n\n| data | variant | atomics | fewer | %s |\n%s\n", title, size, unit,
                    machine::name, machine::cost_columns, machine::rule);
        f(static_cast<unsigned>(size));
        return EXIT_SUCCESS;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return EXIT_FAILURE;
    }
}

}  // namespace example
