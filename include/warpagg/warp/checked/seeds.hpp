// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <type_traits>

namespace warpagg::emulator {

/// Returns the seed in the environment variable WARPAGG_SEED, which replays a failure, or nothing if
/// the variable is not set or empty. Exits the program with an error if it is not a number.
inline std::optional<std::uint64_t> seed_in_environment() {
    const char* text = std::getenv("WARPAGG_SEED");
    if (text == nullptr || *text == '\0') return std::nullopt;
    char* end = nullptr;
    const std::uint64_t seed = std::strtoull(text, &end, 10);
    if (*end != '\0') {
        std::fprintf(stderr, "warpagg: WARPAGG_SEED=%s is not a number\n", text);
        std::exit(EXIT_FAILURE);
    }
    return seed;
}

namespace detail {

/// Prints the seed in its destructor unless `passed` is set, so also if an exception is thrown.
struct seed_on_failure {
    std::uint64_t seed;
    bool passed = false;
    ~seed_on_failure() {
        if (!passed)
            std::fprintf(stderr, "warpagg: failed; replay with WARPAGG_SEED=%llu\n",
                         static_cast<unsigned long long>(seed));
    }
};

}  // namespace detail

/// Calls f(seed) for the seeds 1 to n, or only for WARPAGG_SEED if that is set. Stops at the first
/// failure and prints its seed on stderr. A failure is an exception, which is passed on, or the
/// return value false; an `f` that returns void fails by exceptions only. Returns whether all passed.
///
/// ```cpp
/// emulator::for_each_seed(200, [](std::uint64_t seed) {
///     return emulator::try_launch({.seed = seed}, kernel).ok();
/// });
/// ```
template <class F>
bool for_each_seed(std::uint64_t n, F f) {
    const auto run = [&f](std::uint64_t seed) {
        detail::seed_on_failure guard{seed};
        if constexpr (std::is_void_v<std::invoke_result_t<F&, std::uint64_t>>) {
            f(seed);
            guard.passed = true;
        } else {
            guard.passed = static_cast<bool>(f(seed));
        }
        return guard.passed;
    };
    if (const auto only = seed_in_environment()) return run(*only);
    for (std::uint64_t seed = 1; seed <= n; ++seed)
        if (!run(seed)) return false;  // mutate: seeds_go_on_after_a_failure
    return true;
}

namespace detail {

/// The source of random numbers for the schedule: splitmix64.
class random_source {
  public:
    explicit random_source(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits() {
        state_ += 0x9e3779b97f4a7c15u;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// Returns a random integer from 0 to n - 1.
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(((bits() >> 32) * n) >> 32); }

  private:
    std::uint64_t state_;
};

}  // namespace detail
}  // namespace warpagg::emulator
