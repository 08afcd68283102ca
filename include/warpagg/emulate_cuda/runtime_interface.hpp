// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The functions by which emulated kernels call the emulator. They are defined in runtime.hpp, which is
/// compiled without -fsanitize=thread, so that only kernels report their memory accesses.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "../core/call_site.hpp"
#include "../warp/checked/diagnosis.hpp"
#include "vector_types.hpp"

namespace warpagg::emulator {

struct cuda_grid;

namespace detail::runtime {

/// The lanes that meet in a collective. With `all`, it is an error if one of them has returned.
struct lanes {
    std::uint32_t mask = ~std::uint32_t{0};
    bool all = true;
};

unsigned lane();
void barrier(const call_site& at);
/// Waits as `barrier`. Returns the number of threads of the block that pass true.
unsigned count_at_barrier(bool p, const call_site& at);
void sync(lanes who, const call_site& at);
std::uint32_t vote(lanes who, bool p, const call_site& at);
std::uint32_t match(lanes who, std::uint64_t key, const call_site& at);
std::uint32_t activemask(const call_site& at);
/// Defined for float, double, and unsigned integers.
template <class T>
T exchange_word(lanes who, T v, unsigned from, const call_site& at);

/// Checks an access, with the operand `v` of an atomic. Until `end_access`, accesses are not reported.
/// @{
void begin_read(const void* address, std::size_t size, const call_site& at);
template <class T>
void begin_atomic(T* address, T v, const call_site& at);
void begin_write(const void* address, std::size_t size, const call_site& at);
void end_access();
/// @}

/// The rules of the library's calls; see `emulator::checked`.
/// @{
void require_uniform(const void* destination, const call_site& at);
void require_busy(bool busy, const call_site& at);
void enter(const call_site& at);
void leave();
void enter_loop(const call_site& at);
void next_iteration();
void leave_loop();
/// @}

/// Runs `thread(kernel)` once per thread of the grid.
report run(const cuda_grid& g, void (*thread)(const void* kernel), const void* kernel);
/// Between these two calls, the accesses of a thread are those of its kernel.
void enter_kernel();
void leave_kernel();

/// Memory that kernels may access. `define` marks it as initialized.
void* allocate(std::size_t bytes);
void deallocate(void* memory);
void define(const void* memory, std::size_t bytes);
/// Makes the variable at `address`, of `capacity` bytes, the calling thread's dynamic shared memory.
void add_dynamic_shared(void* (*address)(), std::size_t capacity);

/// The unsigned integer of N bytes.
template <std::size_t N>
using bits = std::conditional_t<
    N == 8, std::uint64_t,
    std::conditional_t<N == 4, std::uint32_t, std::conditional_t<N == 2, std::uint16_t, std::uint8_t>>>;

template <class T>
inline constexpr bool is_word =
    std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, long double>;

/// The type that stands for T in the interface.
template <class T>
using word = std::conditional_t<std::is_floating_point_v<T>, T, bits<sizeof(T)>>;

/// Returns the value of lane `from`, of any trivially copyable type.
template <class T>
T exchange(lanes who, const T& v, unsigned from, const call_site& at) {
    static_assert(std::is_trivially_copyable_v<T>);
    if constexpr (is_word<T>) {
        return std::bit_cast<T>(exchange_word(who, std::bit_cast<word<T>>(v), from, at));
    } else if constexpr (std::is_same_v<T, bool>) {
        return (exchange_word(who, std::uint8_t{v}, from, at) & 1u) != 0;
    } else {
        constexpr std::size_t size = sizeof(T) % 4 == 0 ? 4 : 1;
        struct pieces {
            bits<size> at[sizeof(T) / size];
        } all = std::bit_cast<pieces>(v);
        for (auto& piece : all.at) piece = exchange_word(who, piece, from, at);
        return std::bit_cast<T>(all);
    }
}

/// Returns `*from`, as a read at `at`.
template <class T>
T read(const T* from, const call_site& at) {
    begin_read(from, sizeof(T), at);
    const T v = *from;
    end_access();
    return v;
}
template <class T>
void write(T* to, const T& v, const call_site& at) {
    begin_write(to, sizeof(T), at);
    *to = v;
    end_access();
}
/// Replaces `*to` by `combine(*to, v)` as one atomic at `at`. Returns the value before.
template <class T, class F>
T update(T* to, T v, F combine, const call_site& at) {
    using W = word<T>;
    begin_atomic(reinterpret_cast<W*>(to), std::bit_cast<W>(v), at);
    const T before = *to;
    *to = combine(before, v);
    end_access();
    return before;
}

}  // namespace detail::runtime
}  // namespace warpagg::emulator
