# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Classic bugs, each as a change of one place in a kernel of this folder. test_classic_bugs.cpp lists what
# the emulator must report.

# bug(NAME KERNEL BEFORE AFTER): writes the file NAME.cu, a copy of KERNEL.cu with another text in one place.
function(bug name kernel before after)
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/emulate_cuda/${kernel}.cu)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(READ ${source} text)
    string(FIND "${text}" "${before}" first)
    string(FIND "${text}" "${before}" last REVERSE)
    if(first EQUAL -1 OR NOT first EQUAL last)
        message(FATAL_ERROR "${kernel}.cu does not contain the text of the bug ${name} exactly once")
    endif()
    string(REPLACE "${before}" "${after}" text "${text}")
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/classic_bugs/${name}.cu CONTENT "${text}" @ONLY)
endfunction()

bug(missing_barrier blend_backward
    "        __syncthreads();  // the batch is complete\n"
    "")
bug(barrier_in_a_branch blend_backward
    "        __syncthreads();  // the previous batch is no longer needed\n"
    "        if (rank < end) __syncthreads();\n")
bug(early_return_before_a_barrier blend_backward
    "    const int pixel = y * width + x;\n"
    "    const int pixel = y * width + x;\n    if (!inside) return;\n")
bug(read_past_the_list blend_backward
    "for (int end = in_tile; end > 0;"
    "for (int end = in_tile + 1; end > 0;")
bug(write_past_a_shared_array blend_backward
    "batch_ids[rank] = id;"
    "batch_ids[rank + 1] = id;")
bug(aggregation_after_continue blend_backward
    "atomicAdd(&dL_dopacities[id], dL_dalpha * falloff);"
    "warpagg::warp_reduce_atomic(warpagg::cuda_warp{}, &dL_dopacities[id], {dL_dalpha * falloff}, true);")
bug(plain_sum_instead_of_atomic hash_grid_backward
    "atomicAdd(&table[entry].x, weight * dL_dfeature.x);"
    "table[entry].x += weight * dL_dfeature.x;")
bug(thread_past_the_end hash_grid_backward
    "if (i >= n) return;"
    "if (i > n) return;")
bug(full_mask_in_a_branch sum_positive
    "const unsigned positive = warp.ballot(v > 0.0f);"
    "const unsigned positive = v > 0.0f ? __ballot_sync(0xffffffffu, 1) : 0;")
bug(active_lanes_taken_for_all sum_positive
    "const float warp_sum = cg::reduce(warp, mine, cg::plus<float>());"
    "float warp_sum = mine;
    for (unsigned distance = 16; distance > 0; distance /= 2)
        warp_sum += __shfl_down_sync(__activemask(), warp_sum, distance);")
bug(shuffle_from_an_inactive_lane sum_positive
    "total += warp.shfl_down(total, distance);"
    "if (lane < warps) total += __shfl_down_sync((1u << warps) - 1, total, distance);")
bug(shuffle_from_a_lane_that_returned sum_positive
    "for (unsigned distance = 16; distance > 0; distance /= 2) total"
    "if (lane >= warps) return;
        for (unsigned distance = 16; distance > 0; distance /= 2)
            total += __shfl_down_sync(0xffffffffu, total, distance);
        for (unsigned distance = 0; distance > 0; distance /= 2) total")
bug(warp_synchronous_without_syncwarp sum_positive
    "for (unsigned distance = 16; distance > 0; distance /= 2) total += warp.shfl_down(total, distance);"
    "warp_sums[lane] = total;
        for (unsigned distance = 16; distance > 0; distance /= 2)
            if (lane < distance) warp_sums[lane] += warp_sums[lane + distance];
        total = warp_sums[0];")
bug(uninitialized_shared_memory sum_positive
    "lane < warps ? warp_sums[lane]"
    "lane <= warps ? warp_sums[lane]")
