// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The tags of a policy, except those of its operation (core/operation.hpp) and its accumulator
/// (accumulator.hpp).

#include "axis.hpp"
#include "compiler.hpp"

namespace warpagg {

/// How the values of the lanes are reduced. W is the width of the warp, N the number of values.
/// `shfl_down`, `butterfly` and `scatter` combine lanes in the same tree: lanes W/2 apart first, then
/// half as far, down to neighbors. So their results have the same bits.
namespace reduce {

/// Which lanes hold the results of a reduction.
enum class result_placement {
    own_lane,    ///< each lane holds its own values: for `per_lane` only, which combines nothing
    first_lane,  ///< lane 0 holds all of them
    every_lane,  ///< every lane holds all of them
    spread,      ///< each lane holds some of them: see `scattered_index`
};
/// @cond deprecated
using results_in [[deprecated("use result_placement")]] = result_placement;
/// @endcond

/// No reduction, the baseline. Cost: no shuffle, and N atomics per active lane.
struct per_lane {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::own_lane;
};
/// Lane 0 ends with the results. The paper's Figure 1. Cost: N log2(W) shuffles (N = 9 on 32 lanes:
/// 45).
struct shfl_down {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::first_lane;
};
/// Every lane ends with the results. Cost: N log2(W) shuffles.
struct butterfly {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::every_lane;
};
/// Reduce-scatter: at each of the log2(W) steps a lane sends half of its values to its partner, and
/// ends with at most ceil(N / W) results. Cost: about N - 1 + log2(W / N) shuffles (N = 9 on 32
/// lanes: 12).
struct scatter {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::spread;
};
/// The instruction `redux.sync`: one per value, for 32-bit integers. Models without it, such as the
/// emulators, use `butterfly`.
struct redux {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::every_lane;
};

}  // namespace reduce

/// How the results reach memory.
namespace commit {

/// Lane 0 adds all results, as in the paper. Cost: N atomics, one instruction each.
struct scalar {
    static constexpr auto axis = warpagg::axis::commit;
};
/// N lanes add one result each, at neighboring addresses. Cost: N atomics by ceil(N / W)
/// instructions.
struct contiguous {
    static constexpr auto axis = warpagg::axis::commit;
};
/// One atomic instruction adds K neighboring floats (`red.global.add.v2.f32`, `.v4.f32`); smaller
/// groups follow for the rest. Applies to sums of float in a contiguous record in global memory
/// whose first component is aligned to K floats, from compute capability 9.0 on. Otherwise each
/// component takes one instruction, as with `scalar`. Each component is atomic by itself.
template <unsigned K>
struct packed {
    static_assert(K == 2 || K == 4, "packed<K> takes K = 2 or 4 neighbors");
    static constexpr auto axis = warpagg::axis::commit;
    static constexpr unsigned neighbors = K;  ///< components per instruction
};
/// Adds to a block's copy of the destination in shared memory, which is added to global memory
/// once: see stage.hpp. The destination is a record of a `stage`.
struct staged {
    static constexpr auto axis = warpagg::axis::commit;
};

}  // namespace commit

/// What an idle warp does, one without an active lane.
namespace idle {

/// A vote detects an idle warp, which then does nothing (the paper, Figure 8). Cost: one vote.
struct skip {
    static constexpr auto axis = warpagg::axis::idle;
};
/// The caller knows that the warp is busy. Precondition: at least one lane is active;
/// `emulator::checked`, and CUDA with WARPAGG_CHECKS, verify it. Cost: nothing, but a gate votes.
struct assume_busy {
    static constexpr auto axis = warpagg::axis::idle;
};
/// An idle warp reduces and adds zeros (the paper, Figure 7), for comparison. Cost: no vote, but an
/// idle warp pays for shuffles and atomics.
struct add_zeros {
    static constexpr auto axis = warpagg::axis::idle;
};

}  // namespace idle

/// How many active lanes a reduction needs.
namespace gate {

/// Always reduces. Cost: nothing.
struct always {
    static constexpr auto axis = warpagg::axis::gate;
    static constexpr unsigned lanes = 0;            ///< fewest active lanes that reduce
    static constexpr unsigned lanes_if_packed = 0;  ///< the same for a commit that packs neighbors
};
/// Fewer than K active lanes do not reduce; each commits its own values, by `packed<4>` unless the
/// policy names `packed<2>` or `scalar`. If that commit packs neighbors, the limit is Packed
/// instead of K. Cost: one vote, which replaces the vote of `skip`.
template <unsigned K, unsigned Packed = K>
struct at_least {
    static_assert(K > 0, "at_least<K> takes K > 0: without a gate, say always");
    static constexpr auto axis = warpagg::axis::gate;
    static constexpr unsigned lanes = K;                 ///< fewest active lanes that reduce
    static constexpr unsigned lanes_if_packed = Packed;  ///< the same for a commit that packs neighbors
};

}  // namespace gate

/// The tag as an object, for `policy{...}`.
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

}  // namespace warpagg
