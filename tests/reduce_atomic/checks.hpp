// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// How the promises of `warp_reduce_atomic` are checked on whichever `backend` has been included. A kernel
/// works through many cases, one record each, and the whole memory, guards between the records included, is
/// compared bit by bit with the results of an oracle.

#include <doctest/doctest.h>

#include "../support/cases.hpp"

namespace {

/// The operation on the values of a case's lanes.
struct rule {
    unsigned alone_below = 0;                      ///< with fewer active lanes, each adds its own values
    unsigned alone_below_if_packed = alone_below;  ///< the same where their commit packs neighbors
    bool touched_when_idle = false;
    unsigned packed_neighbors = 4;  ///< how many it packs, in records that are aligned to as many
};
constexpr rule always_alone{width + 1};

template <class Commit>
constexpr unsigned neighbors_of = 1;
template <unsigned K>
constexpr unsigned neighbors_of<warpagg::commit::packed<K>> = K;
template <class T, int N, class Policy, class Resolved = warpagg::detail::resolved_policy<T, N, Policy>>
constexpr rule as_chosen{Resolved::gate::lanes, Resolved::gate::lanes_if_packed, false,
                         neighbors_of<typename Resolved::ungated_commit>};

template <class T, class Op = operation::sum>
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
        for (const lane_bits mask : masks())
            for (const kind k : kinds) {
                add_case(mask, k, random);
                ++cases;
            }
        where = place(cases, n);
        before.assign(where.size, values_of<T>::poison(0));
        for (unsigned c = 0; c < cases; ++c)
            for (unsigned i = 0; i < n; ++i)
                before[where.at(c, i)] = values_of<T>::draw(kinds[(c + c / 3 + i) % 3], random);
    }

    bool is_active(unsigned c, unsigned lane) const { return active[c * width + lane] != 0; }
    /// The values of the active lanes.
    std::vector<T> own_values(unsigned c, unsigned i) const {
        std::vector<T> own;
        for (unsigned lane = 0; lane < width; ++lane)
            if (is_active(c, lane)) own.push_back(value(c, i, lane));
        return own;
    }
    /// The warp's tree over them.
    T tree(unsigned c, unsigned i) const {
        std::vector<T> masked(width, neutral<T>(Op{}));
        for (unsigned lane = 0; lane < width; ++lane)
            if (is_active(c, lane)) masked[lane] = value(c, i, lane);
        return over_tree(Op{}, masked);
    }

    /// Where and how `after` differs first from what `r` makes of this problem; nothing if it does not.
    /// `may_pack`: records are such that `packed<K>` applies if they are aligned.
    std::string first_difference(const std::vector<T>& after, rule r, bool may_pack) const {
        expectation<T> expected(before);
        for (unsigned c = 0; c < cases; ++c) {
            const bool packed =
                may_pack && r.packed_neighbors > 1 && where.at(c, 0) % r.packed_neighbors == 0;
            const unsigned alone_below = packed ? r.alone_below_if_packed : r.alone_below;
            for (unsigned i = 0; i < n; ++i) expect(c, i, alone_below, r.touched_when_idle, expected);
        }
        return expected.first_difference(after);
    }

  private:
    T value(unsigned c, unsigned i, unsigned lane) const { return values[(c * n + i) * width + lane]; }

    void add_case(lane_bits mask, kind k, std::mt19937_64& random) {
        for (unsigned lane = 0; lane < width; ++lane) active.push_back((mask >> lane) & 1u);
        for (unsigned i = 0; i < n; ++i)
            for (unsigned lane = 0; lane < width; ++lane)
                values.push_back(((mask >> lane) & 1u) != 0 ? values_of<T>::draw(k, random)
                                                            : values_of<T>::poison(lane + i));
    }

    void expect(unsigned c, unsigned i, unsigned alone_below, bool touched_when_idle,
                expectation<T>& expected) const {
        const std::size_t cell = where.at(c, i);
        T& result = expected.value[cell];
        const std::vector<T> own = own_values(c, i);
        if (own.empty() && !touched_when_idle) return;
        if (own.size() >= alone_below) {
            result = combined(Op{}, result, tree(c, i));
            return;
        }
        if (!backend::commits_in_lane_order) expected.tolerance[cell] = any_order_error(before[cell], own);
        for (const T& x : own) result = combined(Op{}, result, x);
    }
};

// -------------------------------------------------------------------------------------------- the kernels

/// The ways of naming a record.
struct as_pointer {
    static constexpr bool contiguous = true;
    template <class T>
    WARPAGG_HD T* operator()(T* memory, const layout& where, unsigned c) const {
        return memory + where.at(c, 0);
    }
};
template <unsigned N>
struct as_span {
    static constexpr bool contiguous = true;
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
    static constexpr bool contiguous = false;
    template <class T>
    WARPAGG_HD strided<T> operator()(T* memory, const layout& where, unsigned c) const {
        return {memory + where.at(c, 0), where.component_step};
    }
};

/// Fields of 2, 4 and the other components.
template <int N>
struct as_fields {
    static constexpr bool contiguous = false;
    template <class T>
    WARPAGG_HD auto operator()(T* memory, const layout& where, unsigned c) const {
        using warpagg::at;
        T* const first = memory + where.at(c, 0);
        return warpagg::fields(at<2>(first), at<4>(first + 2), at<N - 6>(first + 6));
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

// ---------------------------------------------------------------------------------------------- the tests

template <class Call, int N, class Destination = as_pointer, class T, class Op>
std::vector<T> memory_after(const problem<T, Op>& p) {
    backend::memory<T> values(p.values);
    backend::memory<unsigned> active(p.active);
    backend::memory<T> memory(p.before);
    backend::launch(
        add_all<T, N, Destination, Call>{values.data(), active.data(), memory.data(), p.where, p.cases});
    return memory.download();
}

template <class Call, int N, class Destination = as_pointer, class T, class Op>
void check(const problem<T, Op>& p, const char* what, rule r) {
    INFO(std::string(what), ", N = ", N);
    const bool may_pack =
        Destination::contiguous && backend::packs<T>() && std::is_same_v<Op, operation::sum>;
    CHECK(p.first_difference(memory_after<Call, N, Destination>(p), r, may_pack) == "");
}

namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace idle = warpagg::idle;
namespace gate = warpagg::gate;
namespace scope = warpagg::scope;
using warpagg::policy;

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
