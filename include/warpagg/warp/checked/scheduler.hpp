// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "fibers.hpp"
#include "seeds.hpp"

namespace warpagg::emulator::detail {

/// Runs the threads of a block as fibers, one at a time, in random order.
class scheduler {
  public:
    explicit scheduler(random_source& random) : random_(random) {}
    scheduler(const scheduler&) = delete;
    scheduler& operator=(const scheduler&) = delete;
    ~scheduler() {
        while (!fibers_.empty()) {  // from the back, so that the next launch takes them in the same order
            fiber_pool::of_this_thread().give_back(std::move(fibers_.back()));
            fibers_.pop_back();
        }
    }

    /// Runs one round of `loop` on each of `threads` fibers. `loop` must call `begin` once, and
    /// `finish` after each round. Returns when all fibers have finished, or one has called `abandon`.
    void run(unsigned threads, void (*loop)()) {
        while (fibers_.size() < threads) fibers_.push_back(fiber_pool::of_this_thread().take());
        runnable_.clear();
        patient_ = 0;
        for (unsigned t = 0; t < threads; ++t) {
            fibers_[t]->prepare(loop);
            runnable_.push_back(t);
        }
        take_next();
        own_.switch_to(fibers_[current_]->own_context());
    }

    unsigned current() const { return current_; }
    void begin() { fibers_[current_]->own_context().arrived(); }
    /// Returns whether the address lies on the stack of the running fiber.
    bool on_stack(const void* address) const { return fibers_[current_]->has(address); }

    /// Suspends the running fiber until `wake`. Precondition: a fiber is runnable, possibly this one.
    void sleep() {
        context& me = fibers_[current_]->own_context();
        take_next();
        context& next = fibers_[current_]->own_context();
        if (&next != &me) me.switch_to(next);
    }
    void wake(unsigned thread) { runnable_.push_back(thread); }
    /// Gives other runnable fibers a chance to run first.
    void let_others_run() {
        wake(current_);
        sleep();
    }

    /// Lets other fibers run until all of them sleep, have finished, or wait in this function.
    void let_others_run_first() {
        ++patient_;
        while (runnable_.size() >= patient_) let_others_run();  // mutate: undefined_read_does_not_wait
        --patient_;
    }

    /// Ends the round of the running fiber. Returns in the next round, or in the next launch.
    void finish() {
        fiber& me = *fibers_[current_];
        me.park();
        if (runnable_.empty()) {
            me.own_context().switch_to(own_);
        } else {
            take_next();
            me.own_context().switch_to(fibers_[current_]->own_context());
        }
    }
    /// Makes `run` return. No fiber continues.
    [[noreturn]] void abandon() {
        fibers_[current_]->own_context().switch_to(own_);
        __builtin_unreachable();
    }

  private:
    void take_next() {
        // mutate: schedule_not_drawn
        const unsigned i = random_.below(static_cast<std::uint32_t>(runnable_.size()));
        current_ = runnable_[i];
        runnable_[i] = runnable_.back();
        runnable_.pop_back();
    }

    random_source& random_;
    context own_;
    std::vector<std::unique_ptr<fiber>> fibers_;
    std::vector<unsigned> runnable_;
    unsigned current_ = 0;
    std::size_t patient_ = 0;  // fibers in let_others_run_first
};

}  // namespace warpagg::emulator::detail
