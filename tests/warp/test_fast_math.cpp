// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What holds of the emulators in a program compiled with -ffast-math, as this one is:
/// - integers and the other operations, bit by bit: tests of theirs are compiled into the same program;
/// - sums of finite floats, within the bound of any order, n u times the sum of magnitudes;
/// - which lanes take part: finite values of inactive lanes count for nothing, and the memory of an idle warp
///   is not touched.
/// What does not, because the compiler may then assume that there is none of it: that a NaN or infinity of an
/// inactive lane ends at the mask; that reductions agree to the bit; the sign of a zero; denormals.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>
#include <warpagg/warp/simd.hpp>

#if !defined(__FAST_MATH__)
#error "to be compiled with -ffast-math"
#endif

namespace {

using warpagg::policy;
using warpagg::simd_value;
namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace gate = warpagg::gate;

constexpr int n = 5;

/// n values for each of 32 lanes, the same for each model: `serial` runs the lanes one after the other.
template <class T>
struct input {
    T value[n][32];
    std::uint32_t active;
    T before[n];

    explicit input(std::mt19937& random) : active(static_cast<std::uint32_t>(random())) {
        std::uniform_real_distribution<T> draw(T(-8), T(8));
        for (int i = 0; i < n; ++i) {
            before[i] = draw(random);
            for (int lane = 0; lane < 32; ++lane)
                value[i][lane] = is_active(lane) ? draw(random) : T(1e30);  // large, but finite
        }
    }
    bool is_active(int lane) const { return ((active >> lane) & 1u) != 0; }

    /// The sum as nearly as the compiler lets us have it, and how far from it a float's may be.
    void check_near(const T (&after)[n], T unit_roundoff) const {
        for (int i = 0; i < n; ++i) {
            long double sum = before[i], magnitude = std::fabs(before[i]);
            for (int lane = 0; lane < 32; ++lane)
                if (is_active(lane)) {
                    sum += value[i][lane];
                    magnitude += std::fabs(value[i][lane]);
                }
            CHECK(std::fabs(static_cast<long double>(after[i]) - sum) <= 33 * unit_roundoff * magnitude);
        }
    }
};

template <class Policy, class T>
void add_on(const warpagg::emulator::lanes& w, const input<T>& q, T (&to)[n]) {
    simd_value<T, 32> v[n];
    simd_value<bool, 32> active;
    for (int lane = 0; lane < 32; ++lane) {
        active.set(lane, q.is_active(lane));
        for (int i = 0; i < n; ++i) v[i].set(lane, q.value[i][lane]);
    }
    warpagg::warp_reduce_atomic(w, to, v, active, Policy{});
}
template <class Policy, class T>
void add_on(const warpagg::emulator::serial& w, const input<T>& q, T (&to)[n]) {
    for (int lane = 0; lane < 32; ++lane) {
        T v[n];
        for (int i = 0; i < n; ++i) v[i] = q.value[i][lane];
        warpagg::warp_reduce_atomic(w, to, v, q.is_active(lane), Policy{});
    }
}

template <class Policy, class W, class T>
void check_sums() {
    std::mt19937 random(3);
    for (int time = 0; time < 100; ++time) {
        input<T> q(random);
        if (time == 0) q.active = 0;
        T memory[n];
        std::copy(q.before, q.before + n, memory);
        add_on<Policy>(W{}, q, memory);
        q.check_near(memory, sizeof(T) == 4 ? T(0x1p-24) : T(0x1p-53));
        if (q.active == 0) CHECK(std::equal(memory, memory + n, q.before));
    }
}

template <class W, class T>
void check_policies() {
    check_sums<policy<>, W, T>();
    check_sums<policy<reduce::shfl_down>, W, T>();
    check_sums<policy<reduce::butterfly>, W, T>();
    check_sums<policy<reduce::scatter, gate::at_least<7>>, W, T>();
    check_sums<policy<reduce::per_lane>, W, T>();
}

}  // namespace

TEST_SUITE_BEGIN("fast math");

TEST_CASE_TEMPLATE("sums of finite floats are near, and of active lanes", T, float, double) {
    check_policies<warpagg::emulator::lanes, T>();
    check_policies<warpagg::emulator::serial, T>();
}

TEST_CASE("sums by keys too") {
    const warpagg::emulator::lanes w;
    const simd_value<float, 32> x = warpagg::convert<float>(w.lane()) + 1.0f;
    const simd_value<float, 32> v[1] = {x};
    float memory[4] = {};
    warpagg::warp_match_reduce_atomic(w, memory, w.lane() & 3u, v, w.lane() < 20u);
    for (int key = 0; key < 4; ++key) CHECK(memory[key] == 5.0f * static_cast<float>(key + 1) + 40.0f);
}

TEST_SUITE_END();
