// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "context.hpp"

namespace warpagg::emulator::detail {

/// A context with its own stack. The page below the stack is not accessible, so a stack overflow
/// crashes the program.
class fiber {
  public:
    /// Size of a stack in bytes. The system provides memory only for the part that a lane uses.
    static constexpr std::size_t stack_size = 256 * 1024;

    /// Maps the stack, or aborts the program. `number` shifts the frames within the stack; otherwise
    /// equal frames of all fibers would share a cache set.
    explicit fiber(std::size_t number) : size_(stack_size - number % 32 * (17 * 64)) {
        void* memory = mmap(nullptr, page() + stack_size, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (memory == MAP_FAILED || mprotect(memory, page(), PROT_NONE) != 0) {
            std::perror("warpagg: no memory for a lane's stack");
            std::abort();
        }
        mapping_ = static_cast<char*>(memory);
    }
    fiber(const fiber&) = delete;
    fiber& operator=(const fiber&) = delete;
    ~fiber() {
        unpoison(mapping_, page() + stack_size);
        munmap(mapping_, page() + stack_size);
    }

    /// Makes the next switch to the context start `loop`, or continue it after `park`.
    void prepare(void (*loop)()) {
        if (!parked_) context_.start_at(stack(), size_, loop);
        parked_ = false;
    }
    /// Marks the end of a round. The loop calls this before it switches away.
    void park() { parked_ = true; }

    context& own_context() { return context_; }
    bool has(const void* address) const {
        const char* p = static_cast<const char*>(address);
        return p >= stack() && p < stack() + size_;
    }

  private:
    char* stack() const { return mapping_ + page(); }
    static std::size_t page() {
        static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
        return size;
    }

    char* mapping_;
    std::size_t size_;
    context context_;
    bool parked_ = false;
};

/// The fibers of a thread, which its launches reuse.
class fiber_pool {
  public:
    static fiber_pool& of_this_thread() {
        static thread_local fiber_pool pool;
        return pool;
    }

    std::unique_ptr<fiber> take() {
        if (free_.empty()) return std::make_unique<fiber>(made_++);
        auto f = std::move(free_.back());
        free_.pop_back();
        return f;
    }
    void give_back(std::unique_ptr<fiber> f) { free_.push_back(std::move(f)); }

  private:
    std::vector<std::unique_ptr<fiber>> free_;
    std::size_t made_ = 0;
};

}  // namespace warpagg::emulator::detail
