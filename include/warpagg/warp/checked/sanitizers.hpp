// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Functions that inform AddressSanitizer and ThreadSanitizer of fibers. Without sanitizers they do
/// nothing.

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define WARPAGG_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define WARPAGG_ASAN 1
#endif
#endif
#if defined(__SANITIZE_THREAD__)
#define WARPAGG_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define WARPAGG_TSAN 1
#endif
#endif

#if defined(WARPAGG_ASAN)
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(WARPAGG_TSAN)
#include <sanitizer/tsan_interface.h>
extern "C" {
void AnnotateIgnoreReadsBegin(const char* file, int line);
void AnnotateIgnoreReadsEnd(const char* file, int line);
void AnnotateIgnoreWritesBegin(const char* file, int line);
void AnnotateIgnoreWritesEnd(const char* file, int line);
}
#endif

/// Excludes a function from all sanitizers.
#define WARPAGG_NO_SANITIZE __attribute__((no_sanitize("address", "thread", "undefined")))

namespace warpagg::emulator::detail {

/// Removes AddressSanitizer's marks of earlier frames from a stack of `size` bytes.
inline void unpoison([[maybe_unused]] const void* stack, [[maybe_unused]] std::size_t size) {
#if defined(WARPAGG_ASAN)
    __asan_unpoison_memory_region(stack, size);
#endif
}

namespace sanitizers {

inline void* create_fiber() {
#if defined(WARPAGG_TSAN)
    return __tsan_create_fiber(0);
#else
    return nullptr;
#endif
}
inline void* current_fiber() {
#if defined(WARPAGG_TSAN)
    return __tsan_get_current_fiber();
#else
    return nullptr;
#endif
}
inline void destroy_fiber([[maybe_unused]] void* fiber) {
#if defined(WARPAGG_TSAN)
    __tsan_destroy_fiber(fiber);
#endif
}

/// A flag that is set in a forked child process. There ThreadSanitizer reports false races, because it
/// ignores synchronization after a fork and takes fibers for threads.
inline bool& forked() {
    static bool yes = false;
    return yes;
}

/// Announces a switch to `fiber`, whose stack has `size` bytes from `bottom`. Call it right before the
/// switch. `ignores` is the flag that `finish_switch` set for the fiber that is left.
WARPAGG_NO_SANITIZE inline void start_switch([[maybe_unused]] void** fake_stack,
                                             [[maybe_unused]] const void* bottom,
                                             [[maybe_unused]] std::size_t size, [[maybe_unused]] void* fiber,
                                             [[maybe_unused]] bool& ignores) {
#if defined(WARPAGG_ASAN)
    __sanitizer_start_switch_fiber(fake_stack, bottom, size);
#endif
#if defined(WARPAGG_TSAN)
    // A fiber that ends while it ignores accesses is an error to ThreadSanitizer.
    if (ignores) {
        AnnotateIgnoreReadsEnd(__FILE__, __LINE__);
        AnnotateIgnoreWritesEnd(__FILE__, __LINE__);
        ignores = false;
    }
    __tsan_switch_to_fiber(fiber, 0);
#endif
}
/// Completes a switch, and returns the stack that was left in `*bottom` and `*size`. Call it right
/// after the switch. `lane` tells whether a fiber was entered, not the thread's own stack. Sets
/// `ignores` if ThreadSanitizer ignores the fiber's accesses from here on.
WARPAGG_NO_SANITIZE inline void finish_switch([[maybe_unused]] void* fake_stack,
                                              [[maybe_unused]] const void** bottom,
                                              [[maybe_unused]] std::size_t* size, [[maybe_unused]] bool lane,
                                              [[maybe_unused]] bool& ignores) {
#if defined(WARPAGG_ASAN)
    __sanitizer_finish_switch_fiber(fake_stack, bottom, size);
#endif
#if defined(WARPAGG_TSAN)
    if (lane && forked()) {
        ignores = true;
        AnnotateIgnoreReadsBegin(__FILE__, __LINE__);
        AnnotateIgnoreWritesBegin(__FILE__, __LINE__);
    }
#endif
}

}  // namespace sanitizers
}  // namespace warpagg::emulator::detail
