// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Contexts of execution, and switches between them. On x86-64 a switch takes a few instructions.
/// Other machines, and builds with WARPAGG_UCONTEXT, use ucontext, which makes a system call per
/// switch. Switches inform AddressSanitizer and ThreadSanitizer. Floating-point modes belong to the
/// thread, not to the fiber.

#include <cstddef>
#include <cstdint>

#include "sanitizers.hpp"

#if defined(__x86_64__) && !defined(WARPAGG_UCONTEXT)
#define WARPAGG_FIBER_SWITCH_X86_64 1
#else
#include <ucontext.h>
#endif

namespace warpagg::emulator::detail {

#if defined(WARPAGG_FIBER_SWITCH_X86_64)
/// Pushes the callee-saved registers, stores the stack pointer in `*from`, loads it from `to`, and
/// continues there.
__attribute__((naked, noinline)) WARPAGG_NO_SANITIZE inline void switch_stack(void** /*from*/, void* /*to*/) {
    asm volatile(
        "pushq %rbp\n pushq %rbx\n pushq %r12\n pushq %r13\n pushq %r14\n pushq %r15\n"
        "movq %rsp, (%rdi)\n movq %rsi, %rsp\n"
        "popq %r15\n popq %r14\n popq %r13\n popq %r12\n popq %rbx\n popq %rbp\n ret\n");
}
#endif

/// A context: a fiber after `start_at`, and otherwise the thread's own stack.
class context {
  public:
    context() = default;
    context(const context&) = delete;
    context& operator=(const context&) = delete;
    ~context() { forget_fiber(); }

    /// Makes the next switch to this context call `entry` on the given stack of `size` bytes, whose
    /// content is lost. Precondition: `entry` does not return.
    void start_at(char* stack, std::size_t size, void (*entry)()) {
        forget_fiber();
        bottom_ = stack;
        size_ = size;
        unpoison(stack, size);
        tsan_fiber_ = sanitizers::create_fiber();
        owns_fiber_ = true;
        ignores_ = false;
#if defined(WARPAGG_FIBER_SWITCH_X86_64)
        constexpr std::size_t kept = 6;
        auto** top = reinterpret_cast<void**>((reinterpret_cast<std::uintptr_t>(stack) + size) / 16 * 16);
        *--top = nullptr;  // unwinding stops here
        *--top = reinterpret_cast<void*>(entry);
        for (std::size_t i = 0; i < kept; ++i) *--top = nullptr;
        pointer_ = top;
#else
        getcontext(&registers_);
        registers_.uc_stack.ss_sp = stack;
        registers_.uc_stack.ss_size = size;
        registers_.uc_link = nullptr;
        makecontext(&registers_, entry, 0);
#endif
    }

    /// Switches from this context to `to`. Returns when another context switches back. Precondition:
    /// this context is running.
    void switch_to(context& to) {
        if (tsan_fiber_ == nullptr) tsan_fiber_ = sanitizers::current_fiber();
        to.came_from_ = this;
        void* fake_stack = nullptr;
        sanitizers::start_switch(&fake_stack, to.bottom_, to.size_, to.tsan_fiber_, ignores_);
#if defined(WARPAGG_FIBER_SWITCH_X86_64)
        switch_stack(&pointer_, to.pointer_);
#else
        swapcontext(&registers_, &to.registers_);
#endif
        arrived(fake_stack);
    }

    /// Ends a switch to this context. Each `entry` must call this first, on its own context.
    void arrived(void* fake_stack = nullptr) {
        const void* bottom = nullptr;
        std::size_t size = 0;
        sanitizers::finish_switch(fake_stack, &bottom, &size, owns_fiber_, ignores_);
        if (came_from_->bottom_ == nullptr) {  // the first switch from the thread's own stack
            came_from_->bottom_ = bottom;
            came_from_->size_ = size;
        }
    }

  private:
    void forget_fiber() {
        if (owns_fiber_) sanitizers::destroy_fiber(tsan_fiber_);
        owns_fiber_ = false;
    }

#if defined(WARPAGG_FIBER_SWITCH_X86_64)
    void* pointer_ = nullptr;
#else
    ucontext_t registers_{};
#endif
    context* came_from_ = nullptr;
    const void* bottom_ = nullptr;
    std::size_t size_ = 0;
    void* tsan_fiber_ = nullptr;
    bool owns_fiber_ = false;
    bool ignores_ = false;
};

}  // namespace warpagg::emulator::detail
