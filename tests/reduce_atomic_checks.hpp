// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// How the promises of `warp_reduce_atomic` are checked on whichever `backend` has been included. A kernel
/// works through many cases, one record each, and the whole memory, guards between the records included, is
/// compared bit by bit with what an oracle computes from the description.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>
#include <warpagg/atomic.hpp>

namespace {

constexpr unsigned width = backend::warp::size;

using warpagg::mask_t;
using warpagg::value_t;

// ---------------------------------------------------------------------------------------------- the cases

/// None, all, each lane alone, the first n, and some at random.
inline std::vector<std::uint32_t> masks() {
    std::vector<std::uint32_t> all{0u, 0xffffffffu};
    for (unsigned lane = 0; lane < 32; ++lane) all.push_back(1u << lane);
    for (unsigned n = 2; n < 32; ++n) all.push_back((1u << n) - 1u);
    std::mt19937 random(7);
    for (int i = 0; i < 20; ++i) all.push_back(static_cast<std::uint32_t>(random()));
    return all;
}

/// How the values of a case are drawn. Sums of signed zeros show whether a lane was masked by zero; and the
/// scales, whether the tree is the promised one. None makes a denormal: `RED` flushes them.
enum class kind { one_scale, many_scales, zeros };
constexpr kind kinds[] = {kind::one_scale, kind::many_scales, kind::zeros};

template <class T>
T draw(kind k, std::mt19937_64& random) {
    if constexpr (std::is_floating_point_v<T>) {
        const T sign = random() % 2 == 0 ? T(1) : T(-1);
        if (k == kind::zeros) return sign * T(0);
        const int range = k == kind::one_scale ? 3 : 30;
        const int exponent = static_cast<int>(random() % static_cast<unsigned>(2 * range + 1)) - range;
        const auto mantissa = static_cast<T>(1.0 + std::ldexp(static_cast<double>(random() >> 11), -53));
        return sign * std::ldexp(mantissa, exponent);
    } else if constexpr (std::is_signed_v<T>) {
        return static_cast<T>(static_cast<int>(random() % (1u << 21)) - (1 << 20));  // sums do not overflow
    } else {
        return static_cast<T>(random());
    }
}

/// What inactive lanes hold: whatever is worst if it gets into a sum.
template <class T>
T poison(unsigned number) {
    using limits = std::numeric_limits<T>;
    if constexpr (std::is_floating_point_v<T>) {
        const T all[] = {limits::quiet_NaN(), limits::infinity(), -limits::infinity(), limits::max(), T(1)};
        return all[number % 5];
    } else {
        const T all[] = {limits::min(), limits::max(), T(1)};
        return all[number % 3];
    }
}

/// Where component i of case c lies, counted in values from the memory's start.
struct layout {
    unsigned first, component_step, case_step, size;
    WARPAGG_HD unsigned at(unsigned c, unsigned i) const {
        return first + c * case_step + i * component_step;
    }
};

constexpr unsigned guard = 3;  // odd, so that records start at every alignment

inline layout records(unsigned cases, unsigned n) {
    return {guard, 1, n + guard, guard + cases * (n + guard)};
}
inline layout structure_of_arrays(unsigned cases, unsigned n) {
    return {guard, cases + guard, 1, guard + n * (cases + guard)};
}

/// What is done with the values of a case's lanes.
struct rule {
    unsigned alone_below = 0;  ///< with fewer active lanes, each adds its own values
    bool touched_when_idle = false;
};
constexpr rule always_alone{33, false};

template <class T>
bool same_bits(T a, T b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// The sum that the documentation promises: pairs of lanes at distance 16, then 8, 4, 2, 1.
template <class T>
T tree_sum(std::vector<T> x) {
    for (std::size_t distance = x.size() / 2; distance > 0; distance /= 2)
        for (std::size_t lane = 0; lane < distance; ++lane) x[lane] = x[lane] + x[lane + distance];
    return x[0];
}

template <class T>
struct problem {
    unsigned cases, n;
    std::vector<T> values;         // [case][component][lane]
    std::vector<unsigned> active;  // [case][lane]
    layout where;
    std::vector<T> before;

    problem(unsigned components, layout (*place)(unsigned, unsigned), std::uint64_t seed = 1)
        : n(components) {
        std::mt19937_64 random(seed);
        cases = 0;
        for (const std::uint32_t mask : masks())
            for (const kind k : kinds) {
                add_case(mask, k, random);
                ++cases;
            }
        where = place(cases, n);
        before.assign(where.size, poison<T>(0));
        for (unsigned c = 0; c < cases; ++c)
            for (unsigned i = 0; i < n; ++i)
                before[where.at(c, i)] = draw<T>(kinds[(c + c / 3 + i) % 3], random);
    }

    T value(unsigned c, unsigned i, unsigned lane) const { return values[(c * n + i) * width + lane]; }
    bool is_active(unsigned c, unsigned lane) const { return active[c * width + lane] != 0; }

    /// Where and how `after` differs first from what `r` makes of this problem; nothing if it does not.
    std::string first_difference(const std::vector<T>& after, rule r) const {
        std::vector<T> expected = before;
        std::vector<long double> tolerance(before.size(), 0.0L);
        for (unsigned c = 0; c < cases; ++c)
            for (unsigned i = 0; i < n; ++i) expect(c, i, r, expected, tolerance);
        for (std::size_t k = 0; k < expected.size(); ++k) {
            if (same_bits(after[k], expected[k])) continue;
            const auto error =
                std::fabs(static_cast<long double>(after[k]) - static_cast<long double>(expected[k]));
            if (tolerance[k] > 0 && error <= tolerance[k]) continue;  // else -0 would pass for +0
            std::ostringstream text;
            text.precision(20);
            text << "cell " << k << " of " << expected.size() << " (" << cases << " cases from cell "
                 << where.first << ", step " << where.case_step << "): " << after[k] << ", expected "
                 << expected[k] << " +- " << tolerance[k] << ", before " << before[k];
            return text.str();
        }
        return "";
    }

  private:
    void add_case(std::uint32_t mask, kind k, std::mt19937_64& random) {
        for (unsigned lane = 0; lane < width; ++lane) active.push_back((mask >> lane) & 1u);
        for (unsigned i = 0; i < n; ++i)
            for (unsigned lane = 0; lane < width; ++lane)
                values.push_back(((mask >> lane) & 1u) != 0 ? draw<T>(k, random) : poison<T>(lane + i));
    }

    void expect(unsigned c, unsigned i, rule r, std::vector<T>& expected,
                std::vector<long double>& tolerance) const {
        const std::size_t cell = where.at(c, i);
        std::vector<T> masked(width, T{});
        std::vector<T> own;
        for (unsigned lane = 0; lane < width; ++lane)
            if (is_active(c, lane)) {
                masked[lane] = value(c, i, lane);
                own.push_back(value(c, i, lane));
            }
        if (own.empty() && !r.touched_when_idle) return;
        if (own.size() >= r.alone_below) {
            expected[cell] = expected[cell] + tree_sum(masked);
            return;
        }
        if (!backend::commits_in_lane_order && std::is_floating_point_v<T> && own.size() > 1) {
            tolerance[cell] = any_order_error(cell, own);
        }
        for (const T x : own) expected[cell] = expected[cell] + x;
    }

    /// In whatever order lanes add, they stay this close to the sum of one order: each is at most 32 u
    /// times the sum of magnitudes from the exact one.
    long double any_order_error(std::size_t cell, const std::vector<T>& own) const {
        long double magnitude = std::fabs(static_cast<long double>(before[cell]));
        for (const T x : own) magnitude += std::fabs(static_cast<long double>(x));
        const long double u = static_cast<long double>(std::numeric_limits<T>::epsilon()) / 2;
        return 2 * 32 * u * magnitude;
    }
};

// -------------------------------------------------------------------------------------------- the kernels

/// The ways of naming a record.
struct as_pointer {
    template <class T>
    WARPAGG_HD T* operator()(T* memory, const layout& where, unsigned c) const {
        return memory + where.at(c, 0);
    }
};
template <unsigned N>
struct as_span {
    template <class T>
    WARPAGG_HD auto operator()(T* memory, const layout& where, unsigned c) const {
        return typename backend::template span<T>{memory + where.at(c, 0), N};
    }
};
template <class T>
struct strided {
    T* first;
    unsigned step;
    WARPAGG_HD T* operator()(unsigned i) const { return first + i * step; }
};
struct as_accessor {
    template <class T>
    WARPAGG_HD strided<T> operator()(T* memory, const layout& where, unsigned c) const {
        return {memory + where.at(c, 0), where.component_step};
    }
};

/// The ways of calling.
template <class Policy>
struct with {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        warpagg::warp_reduce_atomic<T, N>(w, dst, v, active, Policy{});
    }
};
/// `assume_busy`: the caller asks first.
template <class Policy>
struct asked_first {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        if (warpagg::skip_if_warp_idle(w, active)) return;
        warpagg::warp_reduce_atomic<T, N>(w, dst, v, active, Policy{});
    }
};
struct without_policy {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        warpagg::warp_reduce_atomic<T, N>(w, dst, v, active);
    }
};
struct all_deduced {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        warpagg::warp_reduce_atomic(w, dst, v, active);
    }
};
/// The tags as objects, in device code: nvcc must not look for them in the host's memory.
struct tag_objects {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        warpagg::warp_reduce_atomic(w, dst, v, active, warpagg::policy{warpagg::shfl_down});
    }
};
struct gate_objects {
    WARPAGG_EXEC_CHECK_DISABLE
    template <class T, int N, class W, class Dst>
    WARPAGG_HD static void call(const W& w, Dst dst, const value_t<W, T> (&v)[N], const mask_t<W>& active) {
        const warpagg::policy how{warpagg::at_least<4>, warpagg::contiguous, warpagg::skip,
                                  warpagg::butterfly};
        warpagg::warp_reduce_atomic(w, dst, v, active, how);
    }
};

/// Adds every case's values to its record.
template <class T, int N, class Destination, class Call>
struct add_all {
    const T* values;
    const unsigned* active;
    T* memory;
    layout where;
    unsigned cases;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        const mask_t<W> everyone(true);
        const auto lane = w.lane();
        for (unsigned c = 0; c < cases; ++c) {
            value_t<W, T> v[N];
            for (unsigned i = 0; i < N; ++i) v[i] = w.load(values + (c * N + i) * W::size, lane, everyone);
            const mask_t<W> adds = w.load(active + c * W::size, lane, everyone) != 0u;
            Call::template call<T, N>(w, Destination{}(memory, where, c), v, adds);
        }
    }
};

/// Notes each lane's answer of `skip_if_warp_idle` for every case.
struct ask_all {
    const unsigned* active;
    unsigned* answer;
    unsigned cases;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        const mask_t<W> everyone(true);
        const auto lane = w.lane();
        for (unsigned c = 0; c < cases; ++c) {
            const mask_t<W> adds = w.load(active + c * W::size, lane, everyone) != 0u;
            const bool idle = warpagg::skip_if_warp_idle(w, adds);
            w.store(answer + c * W::size, lane, value_t<W, unsigned>(idle ? 1u : 0u), everyone);
        }
    }
};

// ---------------------------------------------------------------------------------------------- the tests

template <class Call, int N, class Destination = as_pointer, class T>
std::vector<T> memory_after(const problem<T>& p) {
    backend::memory<T> values(p.values);
    backend::memory<unsigned> active(p.active);
    backend::memory<T> memory(p.before);
    backend::launch(
        add_all<T, N, Destination, Call>{values.data(), active.data(), memory.data(), p.where, p.cases});
    return memory.download();
}

template <class Call, int N, class Destination = as_pointer, class T>
void check(const problem<T>& p, const char* what, rule r) {
    INFO(what, ", N = ", N);
    CHECK(p.first_difference(memory_after<Call, N, Destination>(p), r) == "");
}

namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace idle = warpagg::idle;
namespace gate = warpagg::gate;
using warpagg::policy;

template <int N, class T>
void check_defaults(const problem<T>& p) {
    check<without_policy, N>(p, "no policy", {});
    check<with<warpagg::default_policy<T, N>>, N>(p, "default_policy", {});
    check<with<policy<>>, N>(p, "no tags", {});
}

template <int N, class T>
void check_reductions(const problem<T>& p) {
    check<with<policy<reduce::per_lane>>, N>(p, "per_lane", always_alone);
    check<with<policy<reduce::shfl_down>>, N>(p, "shfl_down", {});
    check<with<policy<reduce::butterfly>>, N>(p, "butterfly", {});
    check<with<policy<reduce::butterfly, commit::contiguous>>, N>(p, "butterfly contiguous", {});
    check<with<policy<reduce::scatter>>, N>(p, "scatter", {});
}

template <int N, class T>
void check_idle_rules(const problem<T>& p) {
    constexpr rule touched{0, true};
    check<with<policy<idle::add_zeros, reduce::shfl_down>>, N>(p, "add_zeros shfl_down", touched);
    check<with<policy<commit::contiguous, idle::add_zeros, reduce::butterfly>>, N>(
        p, "contiguous add_zeros butterfly", touched);
    check<with<policy<reduce::scatter, idle::add_zeros>>, N>(p, "scatter add_zeros", touched);

    check<asked_first<policy<reduce::shfl_down, commit::scalar, idle::assume_busy, gate::always>>, N>(
        p, "shfl_down scalar assume_busy always", {});
    check<asked_first<policy<idle::assume_busy, reduce::butterfly, commit::scalar>>, N>(
        p, "assume_busy butterfly scalar", {});
    check<asked_first<policy<gate::always, commit::contiguous, idle::assume_busy, reduce::scatter>>, N>(
        p, "always contiguous assume_busy scatter", {});
    check<with<policy<idle::skip, commit::scalar, reduce::per_lane>>, N>(p, "skip scalar per_lane",
                                                                         always_alone);
}

template <int N, class T>
void check_gates(const problem<T>& p) {
    check<with<policy<gate::at_least<1>, reduce::scatter>>, N>(p, "at_least<1> scatter", {1, false});
    check<with<policy<gate::at_least<2>, reduce::shfl_down>>, N>(p, "at_least<2> shfl_down", {2, false});
    check<with<policy<reduce::butterfly, gate::at_least<8>, commit::contiguous>>, N>(
        p, "butterfly at_least<8> contiguous", {8, false});
    check<with<policy<reduce::scatter, gate::at_least<17>, idle::assume_busy>>, N>(
        p, "scatter at_least<17> assume_busy", {17, false});
    check<with<policy<gate::at_least<32>, reduce::butterfly>>, N>(p, "at_least<32> butterfly", {32, false});
    check<with<policy<gate::at_least<33>, reduce::scatter>>, N>(p, "at_least<33> scatter", always_alone);
    check<gate_objects, N>(p, "at_least<4> contiguous skip butterfly, as objects", {4, false});
}

template <int N, class T>
void check_all() {
    const problem<T> p(N, records);
    check_defaults<N>(p);
    check_reductions<N>(p);
    check_idle_rules<N>(p);
    check_gates<N>(p);
}

template <class T>
bool same_memory(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// shfl_down, butterfly and scatter against one another, without the oracle.
template <int N, class T>
void check_same_bits() {
    const problem<T> p(N, records, 2);
    const auto down = memory_after<with<policy<reduce::shfl_down>>, N>(p);
    INFO("N = ", N);
    CHECK_FALSE(same_memory(down, p.before));
    CHECK(same_memory(down, memory_after<with<policy<reduce::butterfly>>, N>(p)));
    CHECK(same_memory(down, memory_after<with<policy<reduce::butterfly, commit::contiguous>>, N>(p)));
    CHECK(same_memory(down, memory_after<with<policy<reduce::scatter>>, N>(p)));
}

}  // namespace
