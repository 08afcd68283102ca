// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include "../../core/counters.hpp"
#include "diagnosis.hpp"
#include "diagnosis_text.hpp"
#include "lane.hpp"
#include "scheduler.hpp"
#include "shadow_memory.hpp"
#include "shadow_process.hpp"
#include "shared_memory.hpp"
#include "undefined.hpp"

// Keeps a function from being inlined. The library unrolls its loops over a warp's operations, so
// inlined operations would compile slowly.
#define WARPAGG_OUT_OF_LINE __attribute__((noinline))

namespace warpagg::emulator::detail {

/// Runs the lanes of a launch, one block at a time. It completes collectives and barriers, and checks
/// memory accesses.
class simulator {
  public:
    /// Simulates blocks of `threads` threads each, in warps of `width` lanes.
    simulator(unsigned blocks, unsigned threads, unsigned width, std::uint64_t seed, counters* count)
        // mutate: seed_ignored
        : blocks_(blocks),
          threads_(threads),
          width_(width),
          count_(count),
          random_(seed),
          scheduler_(random_) {
        report_.seed = seed;
    }
    simulator(const simulator&) = delete;
    simulator& operator=(const simulator&) = delete;

    /// Returns the simulator of the calling lane; null outside kernels.
    static simulator*& running() {
        static thread_local simulator* m = nullptr;
        return m;
    }

    /// Runs `body` once per thread, block after block in random order, until a diagnosis. Rethrows an
    /// exception that leaves `body`.
    template <class F>
    report run(const F& body) {
        body_ = [](simulator& m, const void* f) { (*static_cast<const F*>(f))(m); };
        argument_ = &body;
        simulator* const outer = std::exchange(running(), this);
        std::vector<unsigned> order(blocks_);
        for (unsigned b = 0; b < blocks_; ++b) {
            order[b] = b;
            std::swap(order[b], order[random_.below(b + 1)]);
        }
        for (const unsigned block : order) {
            run_block(block);
            if (stopped_) break;
        }
        running() = outer;
        if (is_shadow()) shadow_process_->hand_over();
#if defined(__cpp_exceptions)
        if (exception_) std::rethrow_exception(exception_);
#endif
        if (report_.ok() && shadow_process_ != nullptr && shadow_process_->differs()) blame_undefined_read();
        return std::move(report_);
    }

    // ------------------------------------------------------- the lane that is running

    unsigned blocks() const { return blocks_; }
    unsigned threads() const { return threads_; }
    unsigned block() const { return block_; }
    unsigned thread() const { return scheduler_.current(); }
    unsigned lane() const { return thread() % width_; }
    unsigned warp_number() const { return thread() / width_; }
    warp_state& warp() { return warps_[warp_number()]; }
    lane_state& self() { return warp().lane[lane()]; }
    warp_state& warp(unsigned number) { return warps_[number]; }
    counters* count() const { return count_; }
    shared_memory& shared() { return shared_; }
    unsigned phase() const { return phase_; }
    bool on_stack(const void* address) const { return scheduler_.on_stack(address); }
    std::size_t undefined_reads() const { return undefined_.count(); }
    void forget(const void* address, std::size_t size) { shadow_.forget(address, size); }

    /// Waits for the other lanes of the mask. The last lane to arrive calls `complete` for all lanes.
    WARPAGG_OUT_OF_LINE void meet(const arrival& a) {
        const std::uint64_t bit = bit_of(lane());
        // mutate: own_bit_not_asked_for
        if ((a.mask & bit) == 0) diagnose([&] { return not_in_mask(self(), a, bit); });
        self().at = a;
        self().waiting = true;
        warp().waiting |= bit;
        if (!try_complete(warp_number(), lane())) settle(warp_number());
        scheduler_.sleep();
    }

    void barrier(const call_site& at) {
        self().at.at = at;
        warp().in_barrier |= bit_of(lane());
        ++in_barrier_;
        settle(warp_number());
        check_barrier();
        scheduler_.sleep();
    }

    /// Returns an undefined value, which a lane reads from a lane `from` that takes no part. The first
    /// call starts a shadow process, if `start_shadow_process` is set.
    template <class T>
    T undefined(unsigned number, unsigned lane, unsigned from) {
        if (shadow_process_ == nullptr && start_shadow_process != nullptr)
            shadow_process_ = start_shadow_process();
        const unsigned thread = number * width_ + lane;
        const undefined_read read{warps_[number].lane[lane].site(), block_, thread, from};
        // mutate: shadow_process_reads_the_same_values
        return undefined_.make<T>(read, random_, is_shadow());
    }

    /// Lets other lanes run, in one of 8 calls.
    void let_others_run_sometimes() {
        if (random_.below(8) == 0) scheduler_.let_others_run();
    }
    /// Lets other lanes run until none can: all of them have returned, or wait for others.
    void let_others_run_first() { scheduler_.let_others_run_first(); }

    /// Diagnoses conflicts of a memory access; may let other lanes run first. Call it before the access.
    WARPAGG_OUT_OF_LINE void access_memory(const void* address, std::size_t size, access_kind kind,
                                           const call_site& here) {
        let_others_run_sometimes();
        if (!on_stack(address)) find_conflict(address, size, kind, here);
    }
    /// Diagnoses conflicts of a memory access. Call it before the access.
    void find_conflict(const void* address, std::size_t size, access_kind kind, const call_site& here) {
        const call_site& at = self().kernel_site(here);
        const access now{block_, thread(), phase_, warp().known[lane()][lane()], kind, 0, at};
        const access* before =
            shadow_.note(address, size, now, [this](const access& a) { return ordered(a); });
        if (before != nullptr) diagnose([&] { return conflict(*before, now, width_); });
    }
    /// Diagnoses conflicts and undefined values. Call it before a write of `value`, or before an atomic
    /// with the operand `value`.
    template <class T>
    WARPAGG_OUT_OF_LINE void write_memory(const void* address, const T& value, access_kind kind,
                                          const call_site& here) {
        access_memory(address, sizeof(T), kind, here);
        find_undefined(address, value, here);
    }
    /// Diagnoses a written value that is undefined, and shows it to the shadow process.
    template <class T>
    void find_undefined(const void* address, const T& value, const call_site& here) {
        const call_site& at = self().kernel_site(here);
        if (const undefined_read* read = undefined_.origin(value))
            diagnose(read->thread / width_,
                     [&] { return inactive_lane_read(*read, read->thread % width_, at); });
        if (shadow_process_ != nullptr)
            shadow_process_->note({at, block_, thread(), undefined_.count()}, address, &value, sizeof(T));
    }

    /// Reports the violation that `find()` returns and ends the launch. Lanes do not continue, so the
    /// caller must not own memory, which would leak.
    template <class F>
    [[noreturn]] void diagnose(unsigned number, F find) {
        note(number, find());
        stopped_ = true;
        scheduler_.abandon();
    }
    template <class F>
    [[noreturn]] void diagnose(F find) {
        diagnose(warp_number(), find);
    }

  private:
    void run_block(unsigned block) {
        block_ = block;
        phase_ = 0;
        in_barrier_ = 0;
        returned_ = 0;
        warps_.assign((threads_ + width_ - 1) / width_, warp_state(width_));
        if (const unsigned rest = threads_ % width_; rest != 0)
            warps_.back() = warp_state(rest);  // mutate: absent_lanes_not_known
        shared_.begin_block([this](const void* first, std::size_t size) { shadow_.forget(first, size); });
        scheduler_.run(threads_, run_threads);
    }

    /// The loop of a fiber, which later launches continue.
    static void run_threads() {
        running()->scheduler_.begin();
        for (;;) running()->run_thread();
    }
    void run_thread() {
#if defined(__cpp_exceptions)
        try {
            body_(*this, argument_);
        } catch (...) {
            exception_ = std::current_exception();
        }
        if (exception_) {
            stopped_ = true;
            scheduler_.abandon();
        }
#else
        body_(*this, argument_);
#endif
        lane_returns();
        scheduler_.finish();  // when it returns, this simulator may not exist
    }

    void lane_returns() {
        const unsigned number = warp_number();
        warp().returned |= bit_of(lane());
        ++returned_;
        // A mask may name lanes that have returned, so this return may complete a collective.
        for_each_lane(warp().waiting, [&](unsigned other) {
            if (warp().lane[other].waiting) try_complete(number, other);
        });
        settle(number);
        check_barrier();
    }

    bool try_complete(unsigned number, unsigned leader) {
        warp_state& w = warps_[number];
        const lane_state& first = w.lane[leader];
        if (first.at.complete == nullptr) return false;
        const std::uint64_t lanes = first.at.all_lanes ? first.at.mask : first.at.mask & ~w.returned;
        if ((w.waiting & lanes) != lanes) return false;
        bool all_meet = true;
        std::uint64_t apart = 0;
        for_each_lane(lanes, [&](unsigned lane) {
            all_meet = all_meet && first.meets(w.lane[lane]);
            // mutate: iterations_not_compared
            if (w.lane[lane].out_of_step(w.lane[first_of(lanes)])) apart |= bit_of(lane);
        });
        if (!all_meet) return false;
        if (apart != 0) diagnose(number, [&] { return out_of_step(first.site(), apart, lanes & ~apart); });
        first.at.complete(*this, number, lanes);
        release(number, lanes);
        return true;
    }

    void release(unsigned number, std::uint64_t lanes) {
        warps_[number].waiting &= ~lanes;
        for_each_lane(lanes, [&](unsigned lane) {
            warps_[number].lane[lane].waiting = false;
            scheduler_.wake(number * width_ + lane);
        });
    }

    /// Answers the calls of `activemask`, or diagnoses, if no lane of the warp can continue.
    void settle(unsigned number) {
        warp_state& w = warps_[number];
        if (!w.stands() || w.waiting == 0) return;
        std::uint64_t asking = 0;
        for_each_lane(w.waiting, [&](unsigned lane) {
            if (w.lane[lane].at.complete == nullptr) asking |= bit_of(lane);
        });
        if (asking == 0) diagnose(number, [&] { return stuck(w); });
        while (asking != 0) {
            const lane_state& first = w.lane[first_of(asking)];
            std::uint64_t together = 0;
            for_each_lane(asking, [&](unsigned lane) {
                if (first.meets(w.lane[lane]) && !first.out_of_step(w.lane[lane])) together |= bit_of(lane);
            });
            partition(w, together);
            asking &= ~together;
            release(number, together);
        }
    }

    /// Splits these lanes into random groups and returns each lane's group from `activemask`, because a
    /// compiler may split a divergent warp in any way.
    void partition(warp_state& w, std::uint64_t lanes) {
        const std::uint32_t parts = 1 + random_.below(3);  // mutate: activemask_names_all
        std::uint64_t part[3] = {};
        std::uint32_t of[warp_state::size] = {};
        for_each_lane(lanes, [&](unsigned lane) { part[of[lane] = random_.below(parts)] |= bit_of(lane); });
        for_each_lane(lanes, [&](unsigned lane) {
            *static_cast<std::uint64_t*>(w.lane[lane].at.operands) = part[of[lane]];
        });
    }

    /// Lets the threads pass the barrier, or diagnoses, if all threads of the block wait at it or have
    /// returned.
    void check_barrier() {
        if (in_barrier_ == 0 || in_barrier_ + returned_ < threads_) return;
        const call_site* at = nullptr;
        for (const warp_state& w : warps_)
            if (at == nullptr && w.in_barrier != 0) at = &w.lane[first_of(w.in_barrier)].site();
        for (unsigned number = 0; number < warps_.size(); ++number) {
            const warp_state& w = warps_[number];
            // mutate: barrier_waits_for_absent_lanes
            if (const std::uint64_t returned = w.returned & ~w.absent; returned != 0)
                diagnose(number, [&] { return barrier_not_reached(*at, returned, in_barrier_, threads_); });
            std::uint64_t elsewhere = 0;
            for_each_lane(w.in_barrier, [&](unsigned lane) {
                // mutate: barriers_not_compared
                if (!same(w.lane[lane].site(), *at)) elsewhere |= bit_of(lane);
            });
            if (elsewhere != 0)
                diagnose(number,
                         [&] { return another_barrier(*at, w.lane[first_of(elsewhere)].site(), elsewhere); });
        }
        ++phase_;
        in_barrier_ = 0;
        for (warp_state& w : warps_) w.in_barrier = 0;
        for (unsigned t = 0; t < threads_; ++t) scheduler_.wake(t);
    }

    /// Returns whether the access `a` is ordered before the running lane's next access.
    bool ordered(const access& a) {
        if (a.block != block_) return false;
        if (a.thread == thread() || a.phase < phase_) return true;
        return a.thread / width_ == warp_number() && warp().known[lane()][a.thread % width_] >= a.clock;
    }

    bool is_shadow() const { return shadow_process_ != nullptr && shadow_process_->is_child(); }

    /// Diagnoses the last undefined read before the first write that differs in the shadow process.
    void blame_undefined_read() {
        const shadow_process::write* write = shadow_process_->first_difference();
        const undefined_read& read =
            write != nullptr ? undefined_.last_of(write->reads_before, write->block, write->thread)
                             : undefined_.last();
        block_ = read.block;
        note(read.thread / width_,
             inactive_lane_read(read, read.thread % width_, write != nullptr ? write->at : read.at));
    }
    void note(unsigned number, violation v) {
        report_.what = v.what;
        report_.at = v.at;
        report_.other = v.other;
        report_.lanes = v.lanes;
        report_.sentence = std::move(v.sentence);
        report_.block = block_;
        report_.warp = number;
    }

    unsigned blocks_, threads_, width_;
    counters* count_;
    random_source random_;
    scheduler scheduler_;
    void (*body_)(simulator&, const void*) = nullptr;
    const void* argument_ = nullptr;

    unsigned block_ = 0;
    std::vector<warp_state> warps_;
    unsigned in_barrier_ = 0, returned_ = 0;
    unsigned phase_ = 0;  // number of barriers that the block has passed
    shared_memory shared_;

    shadow_memory shadow_;
    undefined_values undefined_;
    std::unique_ptr<shadow_process> shadow_process_;  // null before the first undefined read

    bool stopped_ = false;
    report report_;
#if defined(__cpp_exceptions)
    std::exception_ptr exception_;
#endif
};

}  // namespace warpagg::emulator::detail
