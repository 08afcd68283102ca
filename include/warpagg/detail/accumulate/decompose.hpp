// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../warp/concept.hpp"
#include "../destination.hpp"

namespace warpagg {

template <class Accumulate>
struct cell;  // see accumulator.hpp

namespace detail {

/// A destination's cells, as an accessor.
template <class Accumulate, class Dst>
WARPAGG_HD auto cells_of(Dst dst) {
    static_assert(commit::is_destination<Dst>,
                  "the destination is a pointer, a span or an accessor: of a container, pass its data()");
    auto cells = commit::destination(dst);
    static_assert(
        std::is_same_v<decltype(cells(0u)), cell<Accumulate>*>,
        "a sum that is not native is kept in cells: the destination's are cell<...> of the policy's tag");
    return cells;
}

/// The numbers of the cells of a destination, as an accessor by number.
/// @{
template <class Cells, int Numbers>
struct numbers_of_cells {
    Cells cells;
    WARPAGG_HD auto operator()(unsigned i) const { return cells(i / Numbers)->number + i % Numbers; }
};
template <class Accumulate, class Dst>
WARPAGG_HD auto record_of_numbers(Dst dst) {
    auto cells = cells_of<Accumulate>(dst);
    if constexpr (std::is_same_v<decltype(cells), commit::contiguous_record<cell<Accumulate>>>) {
        return cells.first->number;
    } else {
        return numbers_of_cells<decltype(cells), Accumulate::numbers>{cells};
    }
}
/// @}

template <class Accumulate>
inline constexpr bool can_fault = requires(const Accumulate& a) {
    a.fault;
};

/// Takes x apart; whether it could be.
template <class Accumulate>
WARPAGG_HD bool split_one(const Accumulate& how, float x,
                          typename Accumulate::number (&to)[Accumulate::numbers]) {
    if constexpr (can_fault<Accumulate>) {
        return how.split(x, to);
    } else {
        how.split(x, to);
        return true;
    }
}

/// Takes the lanes' values apart, number k of values[i] to numbers[i * Accumulate::numbers + k], and says of
/// those of active lanes that could not be that there are such.
WARPAGG_EXEC_CHECK_DISABLE
template <class Accumulate, warp W, class V, int N, class Number, int M>
WARPAGG_HD void take_apart(const W& w, const Accumulate& how, const V (&values)[N], const mask_t<W>& active,
                           Number (&numbers)[M]) {
    constexpr int each = Accumulate::numbers;
    typename Accumulate::number part[each];
    mask_t<W> fits(true);
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i) {
        if constexpr (requires { typename V::scalar; }) {
            typename Accumulate::number words[each][W::size];  // not set in vectors: see on_words
            for (int lane = 0; lane < static_cast<int>(W::size); ++lane) {
                if (!split_one(how, values[i][lane], part)) fits.set(lane, false);
                for (int k = 0; k < each; ++k) words[k][lane] = part[k];
            }
            for (int k = 0; k < each; ++k) std::memcpy(numbers[i * each + k].part, words[k], sizeof words[k]);
        } else {
            fits = split_one(how, values[i], part) && fits;
            WARPAGG_UNROLL
            for (int k = 0; k < each; ++k) numbers[i * each + k] = part[k];
        }
    }
    if constexpr (can_fault<Accumulate>) {
        if (how.fault == nullptr) return;
        const mask_t<W> faulty = active && !fits;
        if (w.any(faulty))
            w.atomic(operation::bit_or{}, commit::contiguous_record<std::uint32_t>{how.fault},
                     value_t<W, unsigned>(0u), value_t<W, std::uint32_t>(1u), faulty);
    }
}

/// Cells that take what a warp comes to, a float each.
template <class Accumulate, class Cells>
struct cells_of_results {
    Accumulate how;
    Cells cells;
    WARPAGG_HD auto operator()(unsigned i) const { return cells(i); }
};
template <class Accumulate, class Dst>
WARPAGG_HD auto results_to_cells(const Accumulate& how, Dst dst) {
    auto cells = cells_of<Accumulate>(dst);
    return cells_of_results<Accumulate, decltype(cells)>{how, cells};
}
/// Number k of each of them, as an accessor.
template <class Cells>
struct one_number_of_cells {
    Cells cells;
    int k;
    WARPAGG_HD auto operator()(unsigned i) const { return cells(i)->number + k; }
};

/// Commits a value of each active lane to the component that it names.
/// @{
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Dst, class V>
WARPAGG_HD void commit_value(const W& w, Dst dst, const value_t<W, unsigned>& component, const V& v,
                             const mask_t<W>& active) {
    w.atomic(Op{}, dst, component, v, active);
}
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Accumulate, class Cells, class V>
WARPAGG_HD void commit_value(const W& w, const cells_of_results<Accumulate, Cells>& dst,
                             const value_t<W, unsigned>& component, const V& v, const mask_t<W>& active) {
    const V values[1] = {v};
    value_t<W, typename Accumulate::number> numbers[Accumulate::numbers];
    take_apart(w, dst.how, values, active, numbers);
    WARPAGG_UNROLL
    for (int k = 0; k < Accumulate::numbers; ++k)
        w.atomic(typename Accumulate::operation{}, one_number_of_cells<Cells>{dst.cells, k}, component,
                 numbers[k], active);
}
/// @}

}  // namespace detail
}  // namespace warpagg
