// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The functions that code calls if it is compiled with -fsanitize=thread or -fsanitize=bounds. Those of
/// ThreadSanitizer come before each memory access; here they check the accesses of kernels and ignore all
/// others. This header replaces the libraries of both sanitizers.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "thread_state.hpp"

namespace warpagg::emulator::detail::runtime {

inline void note_plain(const void* where, std::size_t size, access_kind kind, const void* return_address,
                       bool is_range) {
    if (thread_state::in_kernel())
        thread_state::instance().plain(where, size, kind, return_address, is_range);
}

/// The descriptions of an index out of bounds, as the compilers write them.
struct bad_index_data {
    const char* file;
    std::uint32_t line, column;
    const struct type {
        std::uint16_t kind, info;
        char name[1];
    } * array, *index;
};
inline std::string index_text(const bad_index_data& data, std::uintptr_t index) {
    const bool is_signed = (data.index->info & 1u) != 0;
    const unsigned unused = 64 - std::min(64u, 1u << (data.index->info >> 1));
    if (!is_signed) return std::to_string(index);
    return std::to_string(static_cast<std::int64_t>(std::uint64_t{index} << unused) >> unused);
}
inline void note_bad_index(const bad_index_data& data, std::uintptr_t index) {
    if (!thread_state::in_kernel()) {
        std::fprintf(stderr, "%s:%u: the index %s is out of bounds of an array of type %s\n", data.file,
                     data.line, index_text(data, index).c_str(), data.array->name);
        std::abort();
    }
    thread_state& state = thread_state::instance();
    state.suspend();
    const call_site at{"[]", data.file, data.line};
    state.m().diagnose([&] {
        return bad_index(state.m().self().kernel_site(at), state.m().lane(), index_text(data, index),
                         data.array->name);
    });
}

}  // namespace warpagg::emulator::detail::runtime

extern "C" {

#define WARPAGG_PLAIN(kind, where, size, range)       \
    ::warpagg::emulator::detail::runtime::note_plain( \
        where, size, ::warpagg::emulator::detail::access_kind::kind, __builtin_return_address(0), range)

#define WARPAGG_HOOKS(size)                                                            \
    void __tsan_read##size(void* p) { WARPAGG_PLAIN(read, p, size, false); }           \
    void __tsan_write##size(void* p) { WARPAGG_PLAIN(write, p, size, false); }         \
    void __tsan_unaligned_read##size(void* p) { WARPAGG_PLAIN(read, p, size, false); } \
    void __tsan_unaligned_write##size(void* p) { WARPAGG_PLAIN(write, p, size, false); }
WARPAGG_HOOKS(1)
WARPAGG_HOOKS(2)
WARPAGG_HOOKS(4)
WARPAGG_HOOKS(8)
WARPAGG_HOOKS(16)
#undef WARPAGG_HOOKS

void __tsan_read_range(void* p, std::size_t size) { WARPAGG_PLAIN(read, p, size, true); }
void __tsan_write_range(void* p, std::size_t size) { WARPAGG_PLAIN(write, p, size, true); }

void __tsan_init() {}
void __tsan_func_entry(void*) {}
void __tsan_func_exit() {}
void __tsan_vptr_read(void**) {}
void __tsan_vptr_update(void**, void*) {}

// Block copies. Compilers call the first ones; the linker's option --wrap redirects calls of libc's to the
// others.
void* __real_memcpy(void*, const void*, std::size_t) __attribute__((weak));
void* __real_memmove(void*, const void*, std::size_t) __attribute__((weak));
void* __real_memset(void*, int, std::size_t) __attribute__((weak));
#define WARPAGG_COPY(name, real)                               \
    void* name(void* to, const void* from, std::size_t size) { \
        WARPAGG_PLAIN(read, from, size, true);                 \
        WARPAGG_PLAIN(write, to, size, true);                  \
        return real(to, from, size);                           \
    }
WARPAGG_COPY(__wrap_memcpy, __real_memcpy)
WARPAGG_COPY(__wrap_memmove, __real_memmove)
WARPAGG_COPY(__tsan_memcpy, std::memcpy)
WARPAGG_COPY(__tsan_memmove, std::memmove)
#undef WARPAGG_COPY
void* __wrap_memset(void* to, int value, std::size_t size) {
    WARPAGG_PLAIN(write, to, size, true);
    return __real_memset(to, value, size);
}
void* __tsan_memset(void* to, int value, std::size_t size) {
    WARPAGG_PLAIN(write, to, size, true);
    return std::memset(to, value, size);
}
#undef WARPAGG_PLAIN

void __ubsan_handle_out_of_bounds(const void* data, std::uintptr_t index) {
    namespace runtime = warpagg::emulator::detail::runtime;
    runtime::note_bad_index(*static_cast<const runtime::bad_index_data*>(data), index);
}

// Atomics of the C++ standard library, in tests around kernels.
#define WARPAGG_ATOMICS(bits, T)                                                                            \
    T __tsan_atomic##bits##_load(const volatile T* p, int) { return __atomic_load_n(p, __ATOMIC_SEQ_CST); } \
    void __tsan_atomic##bits##_store(volatile T* p, T v, int) { __atomic_store_n(p, v, __ATOMIC_SEQ_CST); } \
    T __tsan_atomic##bits##_exchange(volatile T* p, T v, int) {                                             \
        return __atomic_exchange_n(p, v, __ATOMIC_SEQ_CST);                                                 \
    }                                                                                                       \
    T __tsan_atomic##bits##_fetch_add(volatile T* p, T v, int) {                                            \
        return __atomic_fetch_add(p, v, __ATOMIC_SEQ_CST);                                                  \
    }                                                                                                       \
    T __tsan_atomic##bits##_fetch_sub(volatile T* p, T v, int) {                                            \
        return __atomic_fetch_sub(p, v, __ATOMIC_SEQ_CST);                                                  \
    }                                                                                                       \
    T __tsan_atomic##bits##_fetch_and(volatile T* p, T v, int) {                                            \
        return __atomic_fetch_and(p, v, __ATOMIC_SEQ_CST);                                                  \
    }                                                                                                       \
    T __tsan_atomic##bits##_fetch_or(volatile T* p, T v, int) {                                             \
        return __atomic_fetch_or(p, v, __ATOMIC_SEQ_CST);                                                   \
    }                                                                                                       \
    T __tsan_atomic##bits##_fetch_xor(volatile T* p, T v, int) {                                            \
        return __atomic_fetch_xor(p, v, __ATOMIC_SEQ_CST);                                                  \
    }                                                                                                       \
    int __tsan_atomic##bits##_compare_exchange_strong(volatile T* p, T* expected, T v, int, int) {          \
        return __atomic_compare_exchange_n(p, expected, v, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);      \
    }                                                                                                       \
    int __tsan_atomic##bits##_compare_exchange_weak(volatile T* p, T* expected, T v, int, int) {            \
        return __atomic_compare_exchange_n(p, expected, v, true, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);       \
    }                                                                                                       \
    T __tsan_atomic##bits##_compare_exchange_val(volatile T* p, T expected, T v, int, int) {                \
        __atomic_compare_exchange_n(p, &expected, v, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);            \
        return expected;                                                                                    \
    }
WARPAGG_ATOMICS(8, std::uint8_t)
WARPAGG_ATOMICS(16, std::uint16_t)
WARPAGG_ATOMICS(32, std::uint32_t)
WARPAGG_ATOMICS(64, std::uint64_t)
#undef WARPAGG_ATOMICS
void __tsan_atomic_thread_fence(int) { __atomic_thread_fence(__ATOMIC_SEQ_CST); }
void __tsan_atomic_signal_fence(int) { __atomic_signal_fence(__ATOMIC_SEQ_CST); }

}  // extern "C"
