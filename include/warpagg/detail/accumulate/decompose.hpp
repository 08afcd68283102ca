// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../warp/concept.hpp"
#include "../destination.hpp"

namespace warpagg {

template <class Accumulate>
struct accumulator;  // see accumulator.hpp

namespace detail {

/// Returns the accumulators of a destination as an accessor.
template <class Accumulate, class Dst>
WARPAGG_HD auto accumulators_of(Dst dst) {
    static_assert(commit::is_destination<Dst>,
                  "the destination is a pointer, a span or an accessor: of a container, pass its data()");
    auto accumulators = commit::destination(dst);
    static_assert(std::is_same_v<decltype(accumulators(0u)), accumulator<Accumulate>*>,
                  "a sum that is not native needs a destination of accumulator<...>, of the policy's tag");
    return accumulators;
}

/// Returns the limbs of the accumulators of a destination, as a pointer or an accessor.
/// @{
template <class Accumulators, int Limbs>
struct limbs_of_accumulators {
    Accumulators accumulators;
    WARPAGG_HD auto operator()(unsigned i) const { return accumulators(i / Limbs)->limb + i % Limbs; }
};
template <class Accumulate, class Dst>
WARPAGG_HD auto record_of_limbs(Dst dst) {
    auto accumulators = accumulators_of<Accumulate>(dst);
    if constexpr (std::is_same_v<decltype(accumulators),
                                 commit::contiguous_record<accumulator<Accumulate>>>) {
        return accumulators.first->limb;
    } else {
        return limbs_of_accumulators<decltype(accumulators), Accumulate::limbs>{accumulators};
    }
}
/// @}

template <class Accumulate>
inline constexpr bool can_fault = requires(const Accumulate& a) {
    a.fault;
};

/// Decomposes x into limbs. Returns whether x is in range, which only `fixed` restricts.
template <class Accumulate>
WARPAGG_HD bool decompose_one(const Accumulate& how, float x,
                              typename Accumulate::limb (&to)[Accumulate::limbs]) {
    if constexpr (can_fault<Accumulate>) {
        return how.decompose(x, to);
    } else {
        how.decompose(x, to);
        return true;
    }
}

/// Decomposes N values per lane: limb k of values[i] goes to limbs[i * Accumulate::limbs + k]. Sets
/// `*how.fault` if a value of an active lane is out of range; with a `fault` this takes one vote.
WARPAGG_EXEC_CHECK_DISABLE
template <class Accumulate, warp W, class V, int N, class Limb, int M>
WARPAGG_HD void decompose(const W& w, const Accumulate& how, const V (&values)[N], const mask_t<W>& active,
                          Limb (&limbs)[M]) {
    constexpr int each = Accumulate::limbs;
    typename Accumulate::limb part[each];
    mask_t<W> fits(true);
    WARPAGG_UNROLL
    for (int i = 0; i < N; ++i) {
        if constexpr (requires { typename V::scalar; }) {
            typename Accumulate::limb words[each][W::size];  // arrays, not vectors: see on_words
            for (int lane = 0; lane < static_cast<int>(W::size); ++lane) {
                if (!decompose_one(how, values[i][lane], part)) fits.set(lane, false);
                for (int k = 0; k < each; ++k) words[k][lane] = part[k];
            }
            for (int k = 0; k < each; ++k) std::memcpy(limbs[i * each + k].part, words[k], sizeof words[k]);
        } else {
            fits = decompose_one(how, values[i], part) && fits;
            WARPAGG_UNROLL
            for (int k = 0; k < each; ++k) limbs[i * each + k] = part[k];
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

/// An accessor to accumulators, to which a warp adds one float each.
template <class Accumulate, class Accumulators>
struct accumulators_of_results {
    Accumulate how;
    Accumulators accumulators;
    WARPAGG_HD auto operator()(unsigned i) const { return accumulators(i); }
};
template <class Accumulate, class Dst>
WARPAGG_HD auto results_to_accumulators(const Accumulate& how, Dst dst) {
    auto accumulators = accumulators_of<Accumulate>(dst);
    return accumulators_of_results<Accumulate, decltype(accumulators)>{how, accumulators};
}
/// An accessor to limb k of each accumulator.
template <class Accumulators>
struct one_limb_of_accumulators {
    Accumulators accumulators;
    int k;
    WARPAGG_HD auto operator()(unsigned i) const { return accumulators(i)->limb + k; }
};

/// Commits one value per active lane to the component that the lane names. Cost: one atomic
/// instruction, or one per limb for accumulators.
/// @{
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Dst, class V>
WARPAGG_HD void commit_value(const W& w, Dst dst, const value_t<W, unsigned>& component, const V& v,
                             const mask_t<W>& active) {
    w.atomic(Op{}, dst, component, v, active);
}
WARPAGG_EXEC_CHECK_DISABLE
template <class Op, warp W, class Accumulate, class Accumulators, class V>
WARPAGG_HD void commit_value(const W& w, const accumulators_of_results<Accumulate, Accumulators>& dst,
                             const value_t<W, unsigned>& component, const V& v, const mask_t<W>& active) {
    const V values[1] = {v};
    value_t<W, typename Accumulate::limb> limbs[Accumulate::limbs];
    decompose(w, dst.how, values, active, limbs);
    WARPAGG_UNROLL
    for (int k = 0; k < Accumulate::limbs; ++k)
        w.atomic(typename Accumulate::operation{},
                 one_limb_of_accumulators<Accumulators>{dst.accumulators, k}, component, limbs[k], active);
}
/// @}

}  // namespace detail
}  // namespace warpagg
