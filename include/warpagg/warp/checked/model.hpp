// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../core/atomic_memory.hpp"
#include "../../core/operation.hpp"
#include "../concept.hpp"
#include "simulator.hpp"
#include "watched.hpp"

namespace warpagg::emulator {

namespace detail {
struct cuda_collectives;
}

/// The checked model of `warp`, as one lane sees it. Each lane is a fiber that runs the kernel by
/// itself. Kernels are therefore ordinary scalar code (`if`, loops, early returns), and
/// its value type is `T` itself. The model diagnoses violations of the rules. `try_launch` creates
/// the lanes; docs/tutorials/first_unit_test.md shows how to use it.
///
/// All lanes must call the collectives of the concept, `sync()` and `barrier()`; it is an error if
/// a lane has returned. The operations that end in `_sync`, and `sync(mask)`, work as CUDA's: the
/// lanes of the mask that have not returned must call them. A single lane may call `load`, `store`
/// and their variants, also in branches. As on CUDA, only `sync` and `barrier` order memory
/// accesses. The last parameter of each operation is the call site; leave it at its default.
template <unsigned Size>
class basic_checked {
  public:
    /// The member of this name of the concept `warp`.
    /// @{
    static constexpr unsigned size = Size;
    template <class T>
    using value = T;
    using lane_bits = lane_bits_t<basic_checked>;
    /// @}

    /// Creates the model for the running lane. `try_launch` calls this.
    explicit basic_checked(detail::simulator& m) : simulator_(&m) {}

    unsigned lane() const { return simulator_->lane(); }            ///< Number of the lane in its warp
    unsigned thread_index() const { return simulator_->thread(); }  ///< Index of the thread in its block
    unsigned block_size() const { return simulator_->threads(); }   ///< Number of threads per block
    unsigned block_index() const { return simulator_->block(); }    ///< Index of the block in the grid
    unsigned grid_size() const { return simulator_->blocks(); }     ///< Number of blocks in the grid

    // ------------------------------------------------------- for all lanes

    /// The collective of this name of the concept `warp`.
    /// @{
    lane_bits ballot(bool p, call_site at = call_site::here("ballot")) const {
        return vote(all_lanes, p, at);
    }
    bool any(bool p, call_site at = call_site::here("any")) const { return vote(all_lanes, p, at) != 0; }
    template <class Key>
    lane_bits match(Key key, call_site at = call_site::here("match")) const {
        return equal(all_lanes, key, at);
    }

    template <class T>
    T shfl(T v, unsigned from, call_site at = call_site::here("shfl")) const {
        return exchange(all_lanes, v, from % size, at);
    }
    template <class T>
    T shfl_down(T v, unsigned distance, call_site at = call_site::here("shfl_down")) const {
        return exchange(all_lanes, v, down(distance), at);
    }
    template <class T>
    T shfl_xor(T v, unsigned distance, call_site at = call_site::here("shfl_xor")) const {
        return exchange(all_lanes, v, (lane() ^ distance) % size, at);
    }

    /// @}

    /// Commits the values of active lanes. All lanes call this. Active lanes commit one after another,
    /// in an order drawn from the seed, in which lanes of other warps may intervene.
    template <class Op, class Dst, class Index, class T>
    WARPAGG_OUT_OF_LINE void atomic(Op op, Dst dst, Index index, T v, bool active,
                                    call_site at = call_site::here("atomic")) const {
        T* const to = active ? dst(index) : nullptr;
        commit mine{to};
        meet<T>(all_lanes, at, mine, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            if (counters* c = m.count()) count_commit(*c, {m, warp, lanes});
        });
        if (to == nullptr) return;
        simulator_->write_memory(to, v, detail::access_kind::atomic, at);
        detail::atomic(op, to, v);
    }

    /// Works as `__syncwarp()`: orders all lanes' earlier memory accesses before their later ones.
    void sync(call_site at = call_site::here("sync")) const { synchronize(all_lanes, at); }
    /// Works as `__syncthreads()`. All threads of the block call this.
    void barrier(call_site at = call_site::here("barrier")) const { simulator_->barrier(at); }

    // ------------------------------------------------------- for the lanes of a mask

    /// Works as the CUDA function of this name with two leading underscores. All lanes of the mask that
    /// have not returned call this with the same mask.
    /// @{
    lane_bits ballot_sync(lane_bits mask, bool p, call_site at = call_site::here("ballot_sync")) const {
        return vote({mask}, p, at);
    }
    bool any_sync(lane_bits mask, bool p, call_site at = call_site::here("any_sync")) const {
        return vote({mask}, p, at) != 0;
    }
    template <class T>
    lane_bits match_any_sync(lane_bits mask, T key, call_site at = call_site::here("match_any_sync")) const {
        return equal({mask}, key, at);
    }
    /// Works as the CUDA function of this name. A value from a lane that is not in the mask, or has
    /// returned, is undefined; memory must not depend on it.
    template <class T>
    T shfl_sync(lane_bits mask, T v, unsigned from, call_site at = call_site::here("shfl_sync")) const {
        return exchange({mask}, v, from % size, at);
    }
    template <class T>
    T shfl_down_sync(lane_bits mask, T v, unsigned distance,
                     call_site at = call_site::here("shfl_down_sync")) const {
        return exchange({mask}, v, down(distance), at);
    }
    template <class T>
    T shfl_xor_sync(lane_bits mask, T v, unsigned distance,
                    call_site at = call_site::here("shfl_xor_sync")) const {
        return exchange({mask}, v, (lane() ^ distance) % size, at);
    }
    /// @}
    /// Works as `__syncwarp(mask)`.
    void sync(lane_bits mask, call_site at = call_site::here("sync")) const { synchronize({mask}, at); }

    /// Works as `__activemask()`: returns some of the lanes that wait at this line, with the caller
    /// among them. All lanes in the result get the same result. The seed decides which lanes these
    /// are, because a compiler may split lanes in any way.
    lane_bits activemask(call_site at = call_site::here("activemask")) const {
        std::uint64_t mask = 0;
        simulator_->meet({all_lanes.mask, false, 0, at, &mask, nullptr});
        return static_cast<lane_bits>(mask);
    }

    // ------------------------------------------------------- for a single lane

    /// The operation of this name of the concept `warp`.
    /// @{
    template <class T>
    T load(const T* from, unsigned index, bool active, call_site at = call_site::here("load")) const {
        return active ? read(from + index, at) : T{};
    }
    template <class T, int N>
    void load_packed(const T* from, unsigned index, T (&v)[N], bool active,
                     call_site at = call_site::here("load_packed")) const {
        for (unsigned k = 0; k < N; ++k) v[k] = active ? read(from + index + k, at) : T{};
    }
    template <class T>
    void store(T* to, unsigned index, T v, bool active, call_site at = call_site::here("store")) const {
        if (active) write(to + index, v, at);
    }
    template <class T, int N>
    void store_packed(T* to, unsigned index, const T (&v)[N], bool active,
                      call_site at = call_site::here("store_packed")) const {
        for (unsigned k = 0; k < N; ++k)
            if (active) write(to + index + k, v[k], at);
    }
    template <class T>
    T load_row(const T* from, std::ptrdiff_t first, bool active,
               call_site at = call_site::here("load_row")) const {
        return active ? read(from + first + lane(), at) : T{};
    }
    template <class T>
    T load_row(const T* from, std::ptrdiff_t first, call_site at = call_site::here("load_row")) const {
        return read(from + first + lane(), at);
    }
    template <class T>
    void store_row(T* to, std::ptrdiff_t first, T v, bool active,
                   call_site at = call_site::here("store_row")) const {
        if (active) write(to + first + lane(), v, at);
    }
    /// @}

    /// Returns an uninitialized array of `n` values in the block's shared memory. The line of the call
    /// identifies the array, as in a declaration `__shared__ T a[n]`.
    template <class T>
    watched<T> shared(std::size_t n, call_site at = call_site::here("shared")) const {
        return {static_cast<T*>(simulator_->shared().at(at, n * sizeof(T))), n};
    }

    // ------------------------------------------------------- for the library

    /// Informs or checks the simulator. The library calls this, not kernels.
    /// @{
    void enter(const call_site& at) const { simulator_->self().calls.push_back(at); }
    void leave() const { simulator_->self().calls.pop_back(); }

    void observe(bool active, call_site at = call_site::here("observe")) const {
        if (simulator_->count() == nullptr) return;
        meet<bool>(all_lanes, at, active, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            unsigned busy = 0;
            group<bool>{m, warp, lanes}.each(
                [&](unsigned, bool active_there) { busy += active_there ? 1u : 0u; });
            ++m.count()->active[busy];
        });
    }
    void require_uniform(const void* destination, call_site at = call_site::here("require_uniform")) const {
        meet<void*>(all_lanes, at, destination, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            const group<const void*> g{m, warp, lanes};
            const unsigned first = detail::first_of(lanes);
            std::uint64_t other = 0;
            g.each([&](unsigned lane, const void* there) {
                if (there != g[first]) other |= detail::bit_of(lane);
            });
            if (other == 0) return;
            m.diagnose(warp,
                       [&] { return detail::not_uniform(m.warp(warp).lane[first].site(), other, first); });
        });
    }
    void require_busy(bool busy, call_site at = call_site::here("require_busy")) const {
        meet<bool>(all_lanes, at, busy, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            bool some = false;
            group<bool>{m, warp, lanes}.each([&](unsigned, bool there) { some = some || there; });
            if (!some) m.diagnose(warp, [&] { return detail::idle_warp(m.self().site(), lanes); });
        });
    }

    void enter_loop(const call_site& at) const { simulator_->self().loops.push_back({at, 0}); }
    void next_iteration() const { ++simulator_->self().loops.back().iteration; }
    void leave_loop() const { simulator_->self().loops.pop_back(); }
    /// @}

  private:
    friend struct detail::cuda_collectives;

    struct who {
        lane_bits mask;
        bool all_lanes = false;
    };
    static constexpr who all_lanes{~lane_bits{0}, true};

    /// The operands of the lanes that have met.
    template <class Operands>
    struct group {
        detail::simulator& m;
        unsigned warp;
        std::uint64_t lanes;
        Operands& operator[](unsigned lane) const {
            return *static_cast<Operands*>(m.warp(warp).lane[lane].at.operands);
        }
        bool has(unsigned lane) const { return ((lanes >> lane) & 1u) != 0; }
        template <class F>
        void each(F f) const {
            detail::for_each_lane(lanes, [&](unsigned lane) { f(lane, (*this)[lane]); });
        }
    };

    template <class T, class Operands, class F>
    void meet(who w, const call_site& at, Operands& mine, F complete) const {
        simulator_->meet({w.mask, w.all_lanes, sizeof(T), at,
                          const_cast<std::remove_const_t<Operands>*>(&mine), complete});
    }

    struct ballot_part {
        bool p;
        lane_bits bits = 0;
    };
    WARPAGG_OUT_OF_LINE lane_bits vote(who w, bool p, const call_site& at) const {
        ballot_part mine{p};
        meet<bool>(w, at, mine, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            if (counters* c = m.count()) ++c->votes;  // mutate: votes_not_counted
            const group<ballot_part> g{m, warp, lanes};
            lane_bits bits = 0;
            g.each([&](unsigned lane, ballot_part& part) { bits |= lane_bits{part.p} << lane; });
            g.each([&](unsigned, ballot_part& part) { part.bits = bits; });
        });
        return mine.bits;
    }

    template <class T>
    struct match_part {
        T key;
        lane_bits lanes = 0;
    };
    template <class T>
    lane_bits equal(who w, T key, const call_site& at) const {
        match_part<T> mine{key};
        meet<T>(w, at, mine, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            if (counters* c = m.count()) ++c->votes;
            const group<match_part<T>> g{m, warp, lanes};
            g.each([&](unsigned, match_part<T>& part) {
                g.each([&](unsigned lane, const match_part<T>& other) {
                    part.lanes |= lane_bits{part.key == other.key} << lane;
                });
            });
        });
        return mine.lanes;
    }

    template <class T>
    struct shuffle_part {
        T value;
        unsigned from;
        T result;
    };
    unsigned down(unsigned distance) const { return distance < size - lane() ? lane() + distance : lane(); }
    template <class T>
    WARPAGG_OUT_OF_LINE T exchange(who w, T v, unsigned from, const call_site& at) const {
        shuffle_part<T> mine{v, from, v};
        meet<T>(w, at, mine, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            if (counters* c = m.count()) c->shuffles += (sizeof(T) + 3) / 4;
            const group<shuffle_part<T>> g{m, warp, lanes};
            g.each([&](unsigned lane, shuffle_part<T>& part) {
                // mutate: inactive_lanes_not_poisoned
                part.result = g.has(part.from) ? g[part.from].value : m.undefined<T>(warp, lane, part.from);
            });
        });
        return mine.result;
    }

    void synchronize(who w, const call_site& at) const {
        bool nothing = false;
        meet<bool>(w, at, nothing, [](detail::simulator& m, unsigned warp, std::uint64_t lanes) {
            m.warp(warp).synchronize(lanes);
        });
    }

    struct commit {
        const void* to;  // null if the lane is not active
    };
    static void count_commit(counters& c, const group<commit>& g) {
        std::uintptr_t sectors[size] = {};
        unsigned known = 0;
        g.each([&](unsigned, const commit& part) {
            if (part.to == nullptr) return;
            ++c.atomics;
            const auto sector = reinterpret_cast<std::uintptr_t>(part.to) / 32;
            unsigned i = 0;
            while (i < known && sectors[i] != sector) ++i;
            if (i == known) sectors[known++] = sector;
        });
        c.commits += known > 0 ? 1 : 0;
        c.sectors += known;
    }

    template <class T>
    T read(const T* from, const call_site& at) const {
        simulator_->access_memory(from, sizeof(T), detail::access_kind::read, at);
        return *from;
    }
    template <class T>
    void write(T* to, const T& v, const call_site& at) const {
        simulator_->write_memory(to, v, detail::access_kind::write, at);
        *to = v;
    }

    detail::simulator* simulator_;
};

/// The checked model with 32 lanes, as on NVIDIA's GPUs.
using checked = basic_checked<32>;
/// The checked model with 64 lanes, as on AMD's GPUs for data centers.
using wide_checked = basic_checked<64>;

}  // namespace warpagg::emulator
