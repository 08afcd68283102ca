// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The tags of the axes reduce, commit, idle and gate. The tags of the other axes are in
/// core/operation.hpp and accumulator.hpp.

#include "axis.hpp"
#include "compiler.hpp"

namespace warpagg {

/// Tags that select how the lanes' values are reduced. W is the number of lanes, N the number of
/// values per lane. `shfl_down`, `butterfly` and `scatter` combine lanes in the same tree: first
/// lanes W/2 apart, then W/4 apart, and so on to neighbors. So their results have the same bits.
namespace reduce {

/// The lanes that hold the results of a reduction.
enum class result_placement {
    own_lane,    ///< each lane holds its own values; only for `per_lane`, which reduces nothing
    first_lane,  ///< lane 0 holds all results
    every_lane,  ///< every lane holds all results
    spread,      ///< each lane holds some of the results: see `scattered_index`
};
/// @cond deprecated
using results_in [[deprecated("use result_placement")]] = result_placement;
/// @endcond

/// Does not reduce; the baseline. Cost: no shuffles, but N atomics per active lane.
struct per_lane {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::own_lane;
};
/// A tree reduction that leaves the results in lane 0. Cost: N log2(W) shuffles (45 for N = 9 on 32
/// lanes). Source: the paper, Figure 1.
struct shfl_down {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::first_lane;
};
/// A tree reduction that leaves the results in every lane. Cost: N log2(W) shuffles.
struct butterfly {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::every_lane;
};
/// A reduce-scatter. In each of log2(W) steps a lane sends half of its values to its partner; at the
/// end it holds at most ceil(N / W) results. Cost: about N - 1 + log2(W / N) shuffles (12 for N = 9
/// on 32 lanes).
struct scatter {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::spread;
};
/// The instruction `redux.sync`, for 32-bit integers. It leaves the results in every lane. Models
/// without it, such as the emulators, use `butterfly`. Cost: N instructions, or those of `butterfly`.
struct redux {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::every_lane;
};

}  // namespace reduce

/// Tags that select how the results reach memory.
namespace commit {

/// Lane 0 commits all results, as in the paper. Cost: N atomics, one instruction each.
struct scalar {
    static constexpr auto axis = warpagg::axis::commit;
};
/// N lanes commit one result each, at neighboring addresses. Cost: N atomics in ceil(N / W)
/// instructions.
struct contiguous {
    static constexpr auto axis = warpagg::axis::commit;
};
/// Commits K neighboring floats by one atomic instruction (`red.global.add.v2.f32`, `.v4.f32`), and
/// the remainder in smaller groups. Applies to sums of float from compute capability 9.0 on, in a
/// contiguous record in global memory whose first component is aligned to K floats. In other cases
/// it works as `scalar`. Each component is atomic, but the group as a whole is not.
template <unsigned K>
struct packed {
    static_assert(K == 2 || K == 4, "packed<K> takes K = 2 or 4 neighbors");
    static constexpr auto axis = warpagg::axis::commit;
    static constexpr unsigned neighbors = K;  ///< components per instruction
};
/// Adds to a stage, a block's copy of the destination in shared memory, which is added to global
/// memory once: see stage.hpp. The destination must be a record of a `stage`. Sums only.
struct staged {
    static constexpr auto axis = warpagg::axis::commit;
};

}  // namespace commit

/// Tags that select the behavior of an idle warp, a warp without an active lane.
namespace idle {

/// An idle warp does nothing. Cost: one vote. Source: the paper, Figure 8.
struct skip {
    static constexpr auto axis = warpagg::axis::idle;
};
/// Assumes that the warp is busy. Precondition: at least one lane is active. `emulator::checked`,
/// and CUDA with WARPAGG_CHECKS, verify this. Cost: none.
struct assume_busy {
    static constexpr auto axis = warpagg::axis::idle;
};
/// An idle warp reduces and adds zeros; for comparison. Cost: no vote, but the shuffles and atomics
/// of idle warps. Source: the paper, Figure 7.
struct add_zeros {
    static constexpr auto axis = warpagg::axis::idle;
};

}  // namespace idle

/// Tags that select how many active lanes a reduction needs.
namespace gate {

/// Reduces for any number of active lanes. Cost: none.
struct always {
    static constexpr auto axis = warpagg::axis::gate;
    static constexpr unsigned lanes = 0;            ///< smallest number of active lanes that reduce
    static constexpr unsigned lanes_if_packed = 0;  ///< the limit if the ungated commit is packed
};
/// Reduces only if at least K lanes are active. Otherwise each active lane commits its own values,
/// the ungated commit: by `packed<4>`, unless the policy names `packed<2>` or `scalar`. If that
/// commit packs neighbors, the limit is Packed instead of K. Cost: one vote and a count, in busy warps
/// only.
template <unsigned K, unsigned Packed = K>
struct at_least {
    static_assert(K > 0, "at_least<K> takes K > 0: without a gate, say always");
    static constexpr auto axis = warpagg::axis::gate;
    static constexpr unsigned lanes = K;                 ///< smallest number of active lanes that reduce
    static constexpr unsigned lanes_if_packed = Packed;  ///< the limit if the ungated commit is packed
};

}  // namespace gate

/// All names that a policy needs. `using namespace warpagg::tags` makes them short and imports nothing
/// else of the library. They are also members of `warpagg`.
inline namespace tags {

/// A tag as an object, for `policy{...}`.
/// @{
WARPAGG_TAG reduce::per_lane per_lane{};
WARPAGG_TAG reduce::shfl_down shfl_down{};
WARPAGG_TAG reduce::butterfly butterfly{};
WARPAGG_TAG reduce::scatter scatter{};
WARPAGG_TAG reduce::redux redux{};
WARPAGG_TAG commit::scalar scalar{};
WARPAGG_TAG commit::contiguous contiguous{};
template <unsigned K>
WARPAGG_TAG commit::packed<K> packed{};
WARPAGG_TAG commit::staged staged{};
WARPAGG_TAG idle::skip skip{};
WARPAGG_TAG idle::assume_busy assume_busy{};
WARPAGG_TAG idle::add_zeros add_zeros{};
WARPAGG_TAG gate::always always{};
template <unsigned K, unsigned Packed = K>
WARPAGG_TAG gate::at_least<K, Packed> at_least{};
/// @}

}  // namespace tags
}  // namespace warpagg
