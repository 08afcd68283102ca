// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The tags of a policy, except those of its operation (core/operation.hpp) and its accumulator
/// (accumulator.hpp).

#include "axis.hpp"
#include "compiler.hpp"

namespace warpagg {

/// How the lanes' values become one. W is the warp's width, N the number of values.
namespace reduce {

/// Which lanes have the results afterwards.
enum class result_placement {
    own_lane,    ///< each lane its own values: nothing was combined
    first_lane,  ///< lane 0 all of them
    every_lane,  ///< every lane all of them
    spread,      ///< each lane some of them: see `scattered_index`
};
/// @cond deprecated
using results_in [[deprecated("use result_placement")]] = result_placement;
/// @endcond

/// No reduction, the baseline. Cost: no shuffle, and N atomics per active lane.
struct per_lane {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::own_lane;
};
/// Lane 0 ends with the results. The paper's Figure 1. Cost: N log2(W) shuffles (N = 9 on 32 lanes: 45).
struct shfl_down {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::first_lane;
};
/// Every lane ends with the results. Cost: N log2(W) shuffles.
struct butterfly {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::every_lane;
};
/// Reduce-scatter: at each of the log2(W) steps a lane hands half of the values it still holds to its
/// partner, and ends with at most ceil(N / W) results. Cost: about N - 1 + log2(W / N) shuffles (N = 9 on 32
/// lanes: 12).
struct scatter {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::spread;
};
/// The hardware's own reduction, `redux.sync`: one instruction per value, for integers of 32 bits. A model
/// without it, as the emulators are, takes `butterfly`.
struct redux {
    static constexpr auto axis = warpagg::axis::reduce;
    static constexpr auto placement = result_placement::every_lane;
};

}  // namespace reduce

/// How the results reach memory.
namespace commit {

/// Lane 0 makes them. The paper. Cost: N atomics, one instruction each.
struct scalar {
    static constexpr auto axis = warpagg::axis::commit;
};
/// N lanes make them, at N neighbouring addresses. Cost: N atomics by one instruction, or by ceil(N / W).
struct contiguous {
    static constexpr auto axis = warpagg::axis::commit;
};
/// K neighbouring floats by one atomic instruction (`red.global.add.v2.f32`, `.v4.f32`), what is left by
/// smaller groups. It applies to sums of float in a contiguous record whose first component is aligned to K
/// floats; below compute capability 9.0 and for all else, each component takes an instruction, as with
/// `scalar`. The record lies in global memory. Each component is atomic by itself.
template <unsigned K>
struct packed {
    static_assert(K == 2 || K == 4, "packed<K> takes K = 2 or 4 neighbours");
    static constexpr auto axis = warpagg::axis::commit;
    static constexpr unsigned neighbours = K;  ///< components by one instruction
};
/// Into a block's copy of the destination in shared memory, which is added to memory once: see
/// commit/stage.hpp. The destination is a stage's record.
struct staged {
    static constexpr auto axis = warpagg::axis::commit;
};

}  // namespace commit

/// What happens when no lane is active.
namespace idle {

/// Nothing: a vote asks first. The paper's Figure 8. Cost: one vote.
struct skip {
    static constexpr auto axis = warpagg::axis::idle;
};
/// The caller has asked already. Precondition: there is an active lane; `emulator::checked` verifies it, and
/// CUDA with WARPAGG_CHECKS. Cost: nothing; a gate votes all the same.
struct assume_busy {
    static constexpr auto axis = warpagg::axis::idle;
};
/// Zeros are reduced and added all the same. The paper's Figure 7, for comparison. Cost: no vote, but an idle
/// warp pays for shuffles and atomics.
struct add_zeros {
    static constexpr auto axis = warpagg::axis::idle;
};

}  // namespace idle

/// When the reduction is worth it.
namespace gate {

/// Always. Cost: nothing.
struct always {
    static constexpr auto axis = warpagg::axis::gate;
    static constexpr unsigned lanes = 0;            ///< the fewest active lanes that reduce
    static constexpr unsigned lanes_if_packed = 0;  ///< the same where their commit packs
};
/// Fewer than K active lanes (fewer than Packed, where their commit packs neighbours) make their own atomics,
/// by `packed<4>` unless the policy names `packed<2>` or `scalar`. Cost: one vote, in place of that of
/// `skip`.
template <unsigned K, unsigned Packed = K>
struct at_least {
    static_assert(K > 0, "at_least<K> takes K > 0: without a gate, say always");
    static constexpr auto axis = warpagg::axis::gate;
    static constexpr unsigned lanes = K;                 ///< the fewest active lanes that reduce
    static constexpr unsigned lanes_if_packed = Packed;  ///< the same where their commit packs
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
