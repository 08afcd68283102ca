// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What `warp_match_reduce_atomic` promises, on the `backend` that the including file has chosen and for the
/// value types that it names in TEST_VALUES. Each case has records of its own, one per key, and the whole
/// memory is compared bit by bit with the results of an oracle.

#include <doctest/doctest.h>

#include <map>

#include "../support/cases.hpp"

namespace {

namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace idle = warpagg::idle;
namespace gate = warpagg::gate;
using warpagg::policy;

/// The distribution of a case's keys among `keys` of them.
enum class spread { equal, different, rising, few, odd_one_out, runs, random };
constexpr spread spreads[] = {spread::equal,       spread::different, spread::rising, spread::few,
                              spread::odd_one_out, spread::runs,      spread::random};
constexpr unsigned keys = std::max(32u, width);

inline unsigned draw_key(spread s, unsigned lane, unsigned c) {
    switch (s) {
        case spread::equal:
            return c % keys;
        case spread::different:
            return (lane * 5 + c) % keys;
        case spread::rising:
            return lane;
        case spread::few:
            return (lane * lane + c) % 3;
        case spread::odd_one_out:
            return lane == c % keys ? 7 : 20;
        case spread::runs:
            return lane / 5;
        case spread::random:
            return ((lane + 1) * 2654435761u * (c + 1) >> 16) % keys;
    }
    return 0;
}

/// Where records are and what keys they have: `at(case, key, component)` from the memory's start.
struct table {
    unsigned n, record_step, case_step, first_key;
    WARPAGG_HD unsigned at(unsigned c, unsigned key, unsigned i) const {
        return guard + c * case_step + (key - first_key) * record_step + i;
    }
};
inline table dense(unsigned n) { return {n, n, keys * n + guard, 0}; }
/// With guards between the records, and keys up to 2^32 - 1.
inline table guarded(unsigned n) { return {n, n + 1, keys * (n + 1) + guard, 0xffffffffu - (keys - 1)}; }

template <class T, class Op = operation::sum>
struct match_problem {
    unsigned cases = 0, n;
    table where;
    std::vector<T> values;              // [case][component][lane]
    std::vector<unsigned> active, key;  // [case][lane]
    std::vector<T> before;

    match_problem(unsigned components, table (*place)(unsigned)) : n(components), where(place(components)) {
        std::mt19937_64 random(9);
        for (const lane_bits mask : masks(7))
            for (const spread s : spreads) add_case(mask, s, random);
        before.assign(guard + cases * where.case_step, values_of<T>::poison(0));
        for (unsigned c = 0; c < cases; ++c)
            for (unsigned k = 0; k < keys; ++k)
                for (unsigned i = 0; i < n; ++i)
                    before[where.at(c, where.first_key + k, i)] =
                        values_of<T>::draw(kinds[(c + k + i) % 3], random);
    }

    /// Where and how `after` differs first from what it must be with this gate, none if the policy is
    /// `per_lane`; nothing if it does not.
    std::string first_difference(const std::vector<T>& after, unsigned alone_below) const {
        expectation<T> expected(before);
        for (unsigned c = 0; c < cases; ++c) {
            std::map<unsigned, std::vector<unsigned>> lanes;  // of each key, in their order
            unsigned active_lanes = 0;
            for (unsigned lane = 0; lane < width; ++lane)
                if (active[c * width + lane] != 0) {
                    lanes[key[c * width + lane]].push_back(lane);
                    ++active_lanes;
                }
            for (const auto& [k, peers] : lanes)
                for (unsigned i = 0; i < n; ++i)
                    expect(c, k, i, peers, active_lanes < alone_below, lanes.size() == 1 && active_lanes > 1,
                           expected);
        }
        return expected.first_difference(after);
    }

  private:
    void add_case(lane_bits mask, spread s, std::mt19937_64& random) {
        const kind k = kinds[cases % 3];
        for (unsigned i = 0; i < n; ++i)
            for (unsigned lane = 0; lane < width; ++lane)
                values.push_back(((mask >> lane) & 1u) != 0 ? values_of<T>::draw(k, random)
                                                            : values_of<T>::poison(lane + i));
        for (unsigned lane = 0; lane < width; ++lane) {
            const bool adds = ((mask >> lane) & 1u) != 0;
            active.push_back(adds ? 1u : 0u);
            // Inactive lanes: a key that active ones have, or one far outside.
            const bool outside = !adds && lane % 2 == 0;
            key.push_back(outside ? where.first_key + 0x80000000u + lane
                                  : where.first_key + draw_key(s, lane, cases));
        }
        ++cases;
    }

    /// Pairwise by place: the lanes at places 2i and 2i + 1 first, then again.
    static T over_peers(std::vector<T> x) {
        while (x.size() > 1) {
            std::vector<T> pairs;
            for (std::size_t j = 0; j < x.size(); j += 2)
                pairs.push_back(j + 1 < x.size() ? combined(Op{}, x[j], x[j + 1]) : x[j]);
            x = pairs;
        }
        return x[0];
    }

    void expect(unsigned c, unsigned k, unsigned i, const std::vector<unsigned>& peers, bool alone,
                bool only_key, expectation<T>& expected) const {
        const T* of_lane = &values[(c * n + i) * width];
        std::vector<T> own, masked(width, neutral<T>(Op{}));
        for (const unsigned lane : peers) {
            own.push_back(of_lane[lane]);
            masked[lane] = of_lane[lane];
        }
        const std::size_t cell = where.at(c, k, i);
        T& result = expected.value[cell];
        if (alone) {
            if (!backend::commits_in_lane_order)
                expected.tolerance[cell] = any_order_error(before[cell], own);
            for (const T& x : own) result = combined(Op{}, result, x);
        } else {
            result = combined(Op{}, result, only_key ? over_tree(Op{}, masked) : over_peers(own));
        }
    }
};

/// The ways of naming the records of a case.
template <class T>
struct by_case {
    T* memory;
    table where;
    unsigned c;
    WARPAGG_HD T* operator()(unsigned key, unsigned i) const { return memory + where.at(c, key, i); }
};
struct by_accessor {
    static constexpr table (*place)(unsigned) = guarded;
    template <class T>
    WARPAGG_HD by_case<T> operator()(T* memory, const table& where, unsigned c) const {
        return {memory, where, c};
    }
};
struct by_pointer {
    static constexpr table (*place)(unsigned) = dense;
    template <class T>
    WARPAGG_HD T* operator()(T* memory, const table& where, unsigned c) const {
        return memory + where.at(c, 0, 0);
    }
};

/// The ways of calling.
struct by_one_call {
    template <class W, class Base, class V, int N, class Policy>
    WARPAGG_HD static void call(const W& w, Base base, const value_t<W, unsigned>& key, const V (&v)[N],
                                const mask_t<W>& active, Policy how) {
        warpagg::warp_match_reduce_atomic(w, base, key, v, active, how);
    }
};
/// Keys of 64 bits that differ in their upper half as well.
constexpr std::uint64_t first_wide_key = std::uint64_t{1} << 40;
constexpr WARPAGG_HD std::uint64_t widened(unsigned key) {
    return first_wide_key + (std::uint64_t{key} << 20);
}
template <class Base>
struct by_wide_key {
    Base base;
    WARPAGG_HD auto operator()(std::uint64_t key, unsigned i) const {
        return base(static_cast<unsigned>((key - first_wide_key) >> 20), i);
    }
};
struct with_keys_of_64_bits {
    template <class W, class Base, class V, int N, class Policy>
    WARPAGG_HD static void call(const W& w, Base base, const value_t<W, unsigned>& key, const V (&v)[N],
                                const mask_t<W>& active, Policy how) {
        using warpagg::math::convert;
        const value_t<W, std::uint64_t> wide = (convert<std::uint64_t>(key) << 20u) + first_wide_key;
        warpagg::warp_match_reduce_atomic(w, by_wide_key<Base>{base}, wide, v, active, how);
    }
};
/// A call per component, with keys that are compared once.
template <class Base>
struct one_component {
    Base base;
    unsigned component;
    WARPAGG_HD auto operator()(unsigned key, unsigned) const { return base(key, component); }
};
struct with_keys_compared_once {
    template <class W, class Base, class V, int N, class Policy>
    WARPAGG_HD static void call(const W& w, Base base, const value_t<W, unsigned>& key, const V (&v)[N],
                                const mask_t<W>& active, Policy how) {
        const auto lanes = warpagg::match(w, key, active);
        for (unsigned i = 0; i < N; ++i) {
            const V one[1] = {v[i]};
            lanes.add(one_component<Base>{base, i}, one, how);
        }
    }
};

/// Adds every case's values to the records that its keys name.
template <class T, int N, class Base, class Policy, class Call>
struct match_all {
    const T* values;
    const unsigned* active;
    const unsigned* key;
    T* memory;
    table where;
    unsigned cases;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        const mask_t<W> everyone(true);
        const auto lane = w.lane();
        for (unsigned c = 0; c < cases; ++c) {
            value_t<W, T> v[N];
            for (unsigned i = 0; i < N; ++i) v[i] = w.load(values + (c * N + i) * W::size, lane, everyone);
            const auto mine = w.load(key + c * W::size, lane, everyone);
            const mask_t<W> adds = w.load(active + c * W::size, lane, everyone) != 0u;
            Call::call(w, Base{}(memory, where, c), mine, v, adds, Policy{});
        }
    }
};

template <class Policy, int N, class Base, class Call = by_one_call, class T, class Op>
void check_match(const match_problem<T, Op>& p, const char* what, unsigned alone_below) {
    backend::memory<T> values(p.values);
    backend::memory<unsigned> active(p.active);
    backend::memory<unsigned> key(p.key);
    backend::memory<T> memory(p.before);
    backend::launch(match_all<T, N, Base, Policy, Call>{values.data(), active.data(), key.data(),
                                                        memory.data(), p.where, p.cases});
    INFO(std::string(what), ", N = ", N);
    CHECK(p.first_difference(memory.download(), alone_below) == "");
}

template <int N, class Base, class T>
void check_match_default(const match_problem<T>& p) {
    check_match<policy<>, N, Base>(p, "no tags",
                                   warpagg::detail::resolved_policy<T, N, policy<>>::gate::lanes);
}

template <int N, class T>
void check_match_policies() {
    const match_problem<T> p(N, guarded);
    check_match_default<N, by_accessor>(p);
    check_match<policy<reduce::per_lane>, N, by_accessor>(p, "per_lane", width + 1);
    check_match<policy<reduce::shfl_down>, N, by_accessor>(p, "shfl_down", 0);
    check_match<policy<reduce::butterfly, gate::at_least<5>>, N, by_accessor>(p, "butterfly at_least<5>", 5);
}

template <class Op, class T>
void check_match_operation(const char* what) {
    const match_problem<T, Op> p(3, guarded);
    check_match<policy<Op>, 3, by_accessor>(p, what,
                                            warpagg::detail::resolved_policy<T, 3, policy<Op>>::gate::lanes);
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE_TEMPLATE("lanes with equal keys add as one, in the documented tree", T, TEST_VALUES) {
    check_match_policies<1, T>();
    check_match_policies<9, T>();
    check_match_default<3, by_pointer>(match_problem<T>(3, dense));
    check_match_default<4, by_pointer>(match_problem<T>(4, dense));
    check_match_default<6, by_pointer>(match_problem<T>(6, dense));
    constexpr int more = width + 1;
    check_match_default<more, by_accessor>(match_problem<T>(more, guarded));
}

TEST_CASE_TEMPLATE("keys of 64 bits", T, TEST_VALUES) {
    const match_problem<T> p(3, guarded);
    check_match<policy<reduce::scatter>, 3, by_accessor, with_keys_of_64_bits>(p, "scatter", 0);
    check_match<policy<reduce::per_lane>, 3, by_accessor, with_keys_of_64_bits>(p, "per_lane", width + 1);
}

TEST_CASE_TEMPLATE("match compares keys once for several calls of add", T, TEST_VALUES) {
    const match_problem<T> p(3, guarded);
    check_match<policy<>, 3, by_accessor, with_keys_compared_once>(p, "no tags", 0);
    check_match<policy<reduce::scatter>, 3, by_accessor, with_keys_compared_once>(p, "scatter", 0);
    check_match<policy<reduce::per_lane>, 3, by_accessor, with_keys_compared_once>(p, "per_lane", width + 1);
}

TEST_CASE("other operations than the sum, by keys") {
    check_match_operation<operation::minimum, std::int32_t>("minimum");
    check_match_operation<operation::maximum, std::uint32_t>("maximum");
    check_match_operation<operation::bit_and, std::int64_t>("bit_and");
    check_match_operation<operation::bit_or, std::int32_t>("bit_or");
    check_match_operation<operation::bit_xor, std::uint64_t>("bit_xor");
}

TEST_SUITE_END();
