// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "../../warp/checked/model.hpp"
#include "../launch.hpp"
#include "../runtime_interface.hpp"
#include "code_location.hpp"
#include "memory_map.hpp"

extern constinit thread_local uint3 threadIdx, blockIdx;
extern constinit thread_local dim3 blockDim, gridDim;

namespace warpagg::emulator::detail::runtime {

/// The launch that runs on a thread of the program, and the state of its running lane.
class thread_state {
  public:
    static thread_state& instance() {
        static thread_local thread_state state;
        return state;
    }

    /// Whether the running code is that of a kernel, and not of the emulator.
    static bool& in_kernel() {
        static thread_local bool yes = false;
        return yes;
    }

    simulator& m() { return *simulator::running(); }

    void begin_launch(const cuda_grid& g) {
        grid_ = &g;
        block_ = ~0u;
        tallies_[0].block = tallies_[1].block = ~0u;
        blockDim = g.threads;
        gridDim = g.blocks;
    }
    /// Starts the kernel's part of a thread.
    void begin_thread() {
        if (m().block() != block_) begin_block();
        resume();
    }
    /// Continues the kernel. Sets the built-in variables of the running thread.
    void resume() {
        const dim3 blocks = grid_->blocks, threads = grid_->threads;
        const unsigned t = m().thread(), b = m().block();
        threadIdx = {t % threads.x, t / threads.x % threads.y, t / threads.x / threads.y};
        blockIdx = {b % blocks.x, b / blocks.x % blocks.y, b / blocks.x / blocks.y};
        in_kernel() = true;
    }
    /// Ends the kernel's part; the emulator continues. Diagnoses the last value that the kernel wrote.
    void suspend() {
        in_kernel() = false;
        has_just_written_ = false;
        check_written();  // mutate: plain_writes_not_checked
    }

    /// Checks a plain access of a kernel, whose report returns to `return_address`. Bytes of a range may be
    /// the padding of a struct.
    void plain(const void* where, std::size_t size, access_kind kind, const void* return_address,
               bool is_range) {
        if (is_private(where)) return;
        // GCC reports both accesses of `*a = *b` before either happens, and the write first. So between a
        // write and the next report, no other lane runs and no value is checked.
        // mutate: copies_checked_before_they_happen
        if (has_just_written_ && kind == access_kind::read) {
            in_kernel() = has_just_written_ = false;
        } else {
            suspend();
            m().let_others_run_sometimes();
        }
        const call_site at = plain_access(return_address);
        check(where, size, kind, at, is_range);
        if (kind == access_kind::write) expect_write(where, size, at);
        resume();
    }

    /// Checks an access of the running thread. Call it before the access.
    void access(const void* where, std::size_t size, access_kind kind, const call_site& at) {
        if (is_private(where)) return;
        m().let_others_run_sometimes();
        check(where, size, kind, at, false);
    }
    /// Notes that the next plain write of the running thread is at this place. Its value is checked later,
    /// as it is not known yet.
    void expect_write(const void* where, std::size_t size, const call_site& at) {
        if (is_private(where)) return;
        written_ = {where, size, at};
        has_just_written_ = true;
    }

    /// Counts the threads that pass true at a barrier.
    void count(unsigned phase, bool p) {
        tally& t = tallies_[phase % 2];
        if (t.block != m().block() || t.phase != phase) t = {m().block(), phase, 0};
        t.count += p ? 1 : 0;
    }
    unsigned counted(unsigned phase) const { return tallies_[phase % 2].count; }

  private:
    struct plain_write {
        const void* where;
        std::size_t size;
        call_site at;
    };
    struct tally {
        unsigned block, phase, count;
    };

    void begin_block() {
        block_ = m().block();
        written_ = {};
        shared_.begin_block([this](const void* first, std::size_t size) { m().forget(first, size); });
    }

    void check(const void* where, std::size_t size, access_kind kind, const call_site& at, bool is_range) {
        const auto first = reinterpret_cast<location>(where);
        bool shared = false;
        const tracked_bytes bytes = find(first, size, kind, at, shared);
        m().find_conflict(where, size, kind, at);
        if (bytes.flags == nullptr) return;
        if (kind != access_kind::write && !bytes.has_value(first, size, is_range)) {
            const plain_write before = std::exchange(written_, {});
            m().let_others_run_first();  // another thread that writes here now causes a race
            written_ = before;
            if (!bytes.has_value(first, size, is_range))
                m().diagnose(
                    [&] { return uninitialized_read(m().self().kernel_site(at), m().lane(), shared); });
        }
        bytes.touch(first, size, kind != access_kind::read);
    }

    /// Returns whether the address is on the thread's stack, or is that of a built-in variable.
    bool is_private(const void* where) {
        if (m().on_stack(where)) return true;
        const auto* p = static_cast<const char*>(where);
        const auto in = [p](const auto& v) {
            return p >= reinterpret_cast<const char*>(&v) && p < reinterpret_cast<const char*>(&v + 1);
        };
        return in(threadIdx) || in(blockIdx) || in(blockDim) || in(gridDim);
    }
    /// Finds the memory that is accessed, or diagnoses.
    tracked_bytes find(location first, std::size_t size, access_kind kind, const call_site& at,
                       bool& shared) {
        tracked_bytes bytes = shared_.use(first, size);
        shared = bytes.size > 0;
        const char* what = "an array";
        if (shared) {
            if (const auto dynamic = find_dynamic(first)) {
                what = "the dynamic shared memory";
                bytes.flags += dynamic->first - bytes.first;
                bytes.first = dynamic->first;
                bytes.size = dynamic->size;
            }
        } else {
            bytes = heap_arrays::instance().find(first);
        }
        // mutate: accesses_across_the_end_allowed
        if (first >= bytes.first && first + size <= bytes.first + bytes.size) return bytes;
        if (bytes.size == 0 && !shared && in_program(first, size)) return {};
        m().diagnose([&] {
            std::string where = "that no device_array contains";
            if (bytes.size > 0 || shared) {
                const auto end = bytes.first + bytes.size;
                where = first < bytes.first
                            ? std::to_string(bytes.first - first) + " bytes before the start of "
                        : first < end  ? "across the end of "
                        : first == end ? "right after the end of "
                                       : std::to_string(first - end) + " bytes after the end of ";
                where += what + (" of " + std::to_string(bytes.size)) + " bytes";
            }
            return out_of_bounds(m().self().kernel_site(at), m().lane(), kind, size, where);
        });
    }
    /// Returns the used part of the dynamic shared memory that contains the address.
    std::optional<tracked_bytes> find_dynamic(location a) const {
        for (const dynamic_shared& d : dynamic_arrays()) {
            const auto first = reinterpret_cast<location>(d.address());
            // mutate: dynamic_shared_memory_unlimited
            if (a - first < d.capacity) return tracked_bytes{first, grid_->shared_bytes, nullptr};
        }
        return std::nullopt;
    }

    void check_written() {
        const plain_write w = std::exchange(written_, {});
        if (w.where == nullptr || m().undefined_reads() == 0) return;
        const auto* p = static_cast<const char*>(w.where);
        if (w.size == 8) check_written<double>(p, w.at);
        for (std::size_t i = 0; i + 4 <= w.size; i += 4) check_written<float>(p + i, w.at);
        for (std::size_t i = w.size / 4 * 4; i < w.size; ++i) check_written<char>(p + i, w.at);
    }
    template <class T>
    void check_written(const char* p, const call_site& at) {
        T v;
        std::memcpy(&v, p, sizeof v);
        m().find_undefined(p, v, at);
    }

    const cuda_grid* grid_ = nullptr;
    unsigned block_ = ~0u;
    plain_write written_{};  // by the running thread
    tally tallies_[2]{};
    bool has_just_written_ = false;
    shared_variables shared_;
};

/// Suspends the kernel for the emulator's part of a call.
class in_emulator {
  public:
    in_emulator() { thread_state::instance().suspend(); }
    in_emulator(const in_emulator&) = delete;
    in_emulator& operator=(const in_emulator&) = delete;
    ~in_emulator() { thread_state::instance().resume(); }
};

}  // namespace warpagg::emulator::detail::runtime
