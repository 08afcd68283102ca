// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// CUDA's cooperative groups: the block, its tiles, and reductions over a tile. Each function works as in
/// CUDA; the last parameter is the call site.

#include "builtins.hpp"
#include "runtime_interface.hpp"

namespace cooperative_groups {

/// @{
/// Works as in CUDA.
class thread_block {
  public:
    static void sync(warpagg::call_site at = warpagg::call_site::here("sync")) { __syncthreads(at); }
    static unsigned thread_rank() {
        return threadIdx.x + blockDim.x * (threadIdx.y + blockDim.y * threadIdx.z);
    }
    static unsigned num_threads() { return blockDim.x * blockDim.y * blockDim.z; }
    static unsigned size() { return num_threads(); }
    static dim3 group_index() { return blockIdx; }
    static dim3 thread_index() { return threadIdx; }
    static dim3 group_dim() { return blockDim; }
    static dim3 dim_threads() { return blockDim; }
};
inline thread_block this_thread_block() { return {}; }

template <unsigned Size, class Parent = thread_block>
class thread_block_tile {
    static_assert(Size > 0 && Size <= 32 && (Size & (Size - 1)) == 0,
                  "tiles of 1, 2, 4, 8, 16 or 32 threads");

  public:
    static unsigned thread_rank() { return thread_block::thread_rank() % Size; }
    static unsigned num_threads() { return Size; }
    static unsigned size() { return Size; }
    static unsigned meta_group_rank() { return thread_block::thread_rank() / Size; }
    static unsigned meta_group_size() { return (thread_block::num_threads() + Size - 1) / Size; }

    void sync(warpagg::call_site at = warpagg::call_site::here("sync")) const {
        warpagg::emulator::detail::runtime::sync(who(), at);
    }
    unsigned ballot(int p, warpagg::call_site at = warpagg::call_site::here("ballot")) const {
        return (warpagg::emulator::detail::runtime::vote(who(), p != 0, at) & who().mask) >> first();
    }
    int any(int p, warpagg::call_site at = warpagg::call_site::here("any")) const {
        return warpagg::emulator::detail::runtime::vote(who(), p != 0, at) != 0;
    }
    int all(int p, warpagg::call_site at = warpagg::call_site::here("all")) const {
        return warpagg::emulator::detail::runtime::vote(who(), p == 0, at) == 0;
    }
    template <class T>
    T shfl(T v, unsigned from, warpagg::call_site at = warpagg::call_site::here("shfl")) const {
        return warpagg::emulator::detail::runtime::exchange(who(), v, first() + from % Size, at);
    }
    template <class T>
    T shfl_up(T v, unsigned distance, warpagg::call_site at = warpagg::call_site::here("shfl_up")) const {
        return warpagg::emulator::detail::runtime::exchange(
            who(), v, warpagg::emulator::detail::runtime::lane() - (distance <= thread_rank() ? distance : 0),
            at);
    }
    template <class T>
    T shfl_down(T v, unsigned distance, warpagg::call_site at = warpagg::call_site::here("shfl_down")) const {
        return warpagg::emulator::detail::runtime::exchange(
            who(), v,
            warpagg::emulator::detail::runtime::lane() + (distance < Size - thread_rank() ? distance : 0),
            at);
    }
    template <class T>
    T shfl_xor(T v, unsigned distance, warpagg::call_site at = warpagg::call_site::here("shfl_xor")) const {
        return warpagg::emulator::detail::runtime::exchange(who(), v,
                                                            first() + (thread_rank() ^ distance) % Size, at);
    }

  private:
    static unsigned first() { return warpagg::emulator::detail::runtime::lane() / Size * Size; }
    static warpagg::emulator::detail::runtime::lanes who() { return {(~0u >> (32 - Size)) << first(), true}; }
};
template <unsigned Size>
thread_block_tile<Size> tiled_partition(const thread_block&) {
    return {};
}
template <unsigned Size, unsigned Outer, class Parent>
requires(Size <= Outer) thread_block_tile<Size> tiled_partition(const thread_block_tile<Outer, Parent>&) {
    return {};
}

template <class Group>
void sync(const Group& g, warpagg::call_site at = warpagg::call_site::here("sync")) {
    g.sync(at);
}

template <class T>
struct plus {
    T operator()(T a, T b) const { return a + b; }
};
template <class T>
struct less {
    T operator()(T a, T b) const { return b < a ? b : a; }
};
template <class T>
struct greater {
    T operator()(T a, T b) const { return a < b ? b : a; }
};
template <unsigned Size, class Parent, class T, class Op>
T reduce(const thread_block_tile<Size, Parent>& tile, T v, Op op,
         warpagg::call_site at = warpagg::call_site::here("reduce")) {
    for (unsigned distance = Size / 2; distance > 0; distance /= 2) v = op(v, tile.shfl_xor(v, distance, at));
    return v;
}
/// @}

}  // namespace cooperative_groups
