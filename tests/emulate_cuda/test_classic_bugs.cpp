// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Each classic bug is diagnosed in every schedule. The kernels come from classic_bugs.cmake.

#include <string>

#include "../support/for_each_seed.hpp"
#include "scenes.hpp"

namespace active_lanes_taken_for_all {
#include "classic_bugs/active_lanes_taken_for_all.cu"
}
namespace aggregation_after_continue {
#include "classic_bugs/aggregation_after_continue.cu"
}
namespace barrier_in_a_branch {
#include "classic_bugs/barrier_in_a_branch.cu"
}
namespace early_return_before_a_barrier {
#include "classic_bugs/early_return_before_a_barrier.cu"
}
namespace full_mask_in_a_branch {
#include "classic_bugs/full_mask_in_a_branch.cu"
}
namespace missing_barrier {
#include "classic_bugs/missing_barrier.cu"
}
namespace plain_sum_instead_of_atomic {
#include "classic_bugs/plain_sum_instead_of_atomic.cu"
}
namespace read_past_the_list {
#include "classic_bugs/read_past_the_list.cu"
}
namespace shuffle_from_a_lane_that_returned {
#include "classic_bugs/shuffle_from_a_lane_that_returned.cu"
}
namespace shuffle_from_an_inactive_lane {
#include "classic_bugs/shuffle_from_an_inactive_lane.cu"
}
namespace thread_past_the_end {
#include "classic_bugs/thread_past_the_end.cu"
}
namespace uninitialized_shared_memory {
#include "classic_bugs/uninitialized_shared_memory.cu"
}
namespace warp_synchronous_without_syncwarp {
#include "classic_bugs/warp_synchronous_without_syncwarp.cu"
}
namespace write_past_a_shared_array {
#include "classic_bugs/write_past_a_shared_array.cu"
}

namespace {

using warpagg::emulator::diagnosis;

constexpr std::uint64_t schedules = 200;

/// Checks that every schedule reports `what`, or `or_this`, in the kernel with the bug.
template <class Scene, class Kernel>
void is_diagnosed(const Scene& scene, Kernel* kernel, diagnosis what, diagnosis or_this) {
    for_each_seed(schedules, [&](std::uint64_t seed) {
        const report r = scene.run(kernel, seed);
        INFO(r.text());
        CHECK((r.what == what || r.what == or_this));
        REQUIRE(r.at.file != nullptr);
        CHECK(std::string(r.at.file).find("classic_bugs/") != std::string::npos);
        CHECK(r.at.line > 0);
    });
}
template <class Scene, class Kernel>
void is_diagnosed(const Scene& scene, Kernel* kernel, diagnosis what) {
    is_diagnosed(scene, kernel, what, what);
}

}  // namespace

TEST_CASE("a missing barrier between writes and reads of shared memory") {
    is_diagnosed(blend_scene(5), missing_barrier::blend_backward, diagnosis::data_race);
}
TEST_CASE("a barrier in a branch that only some threads take") {
    is_diagnosed(blend_scene(5), barrier_in_a_branch::blend_backward, diagnosis::different_call_sites);
}
TEST_CASE("an early return before a barrier") {
    is_diagnosed(blend_scene(5), early_return_before_a_barrier::blend_backward,
                 diagnosis::barrier_not_reached);
}
TEST_CASE("a read past the end of a list") {
    is_diagnosed(blend_scene(5), read_past_the_list::blend_backward, diagnosis::out_of_bounds);
}
TEST_CASE("a write past the end of a shared array") {
    is_diagnosed(blend_scene(256), write_past_a_shared_array::blend_backward, diagnosis::out_of_bounds);
}
TEST_CASE("an aggregated call after a continue") {
    // The lanes that skip the call meet the others in a later iteration, or leave the loop.
    is_diagnosed(blend_scene(20), aggregation_after_continue::blend_backward,
                 diagnosis::destination_not_uniform, diagnosis::collective_not_reached);
}
TEST_CASE("a plain sum instead of an atomic") {
    is_diagnosed(hash_grid_scene(), plain_sum_instead_of_atomic::hash_grid_backward, diagnosis::data_race);
}
TEST_CASE("a thread past the end of the data") {
    is_diagnosed(hash_grid_scene(), thread_past_the_end::hash_grid_backward, diagnosis::out_of_bounds);
}
TEST_CASE("a full mask in a branch") {
    is_diagnosed(sum_scene(), full_mask_in_a_branch::sum_positive, diagnosis::different_call_sites);
}
TEST_CASE("the active lanes taken for all lanes") {
    is_diagnosed(sum_scene(), active_lanes_taken_for_all::sum_positive, diagnosis::inactive_lane_read);
}
TEST_CASE("a shuffle from an inactive lane") {
    is_diagnosed(sum_scene(), shuffle_from_an_inactive_lane::sum_positive, diagnosis::inactive_lane_read);
}
TEST_CASE("a shuffle from a lane that returned") {
    is_diagnosed(sum_scene(), shuffle_from_a_lane_that_returned::sum_positive, diagnosis::inactive_lane_read);
}
TEST_CASE("warp-synchronous code without __syncwarp") {
    is_diagnosed(sum_scene(), warp_synchronous_without_syncwarp::sum_positive, diagnosis::data_race);
}
TEST_CASE("uninitialized shared memory") {
    is_diagnosed(sum_scene(), uninitialized_shared_memory::sum_positive, diagnosis::uninitialized_read);
}
