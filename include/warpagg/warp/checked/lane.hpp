// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "../../core/call_site.hpp"
#include "diagnosis.hpp"

namespace warpagg::emulator::detail {

class simulator;

inline std::uint64_t bit_of(unsigned lane) { return std::uint64_t{1} << lane; }
inline unsigned first_of(std::uint64_t lanes) { return static_cast<unsigned>(std::countr_zero(lanes)); }
template <class F>
void for_each_lane(std::uint64_t lanes, F f) {
    for (; lanes != 0; lanes &= lanes - 1) f(first_of(lanes));
}

/// The call with which a lane waits at a collective.
struct arrival {
    std::uint64_t mask;   ///< the lanes that meet
    bool all_lanes;       ///< whether it is an error if a lane of the mask has returned
    unsigned value_size;  ///< size of the value type in bytes
    call_site at;         ///< the call, which may be in the library
    void* operands;       ///< the operands of this lane, of a type that `complete` knows
    void (*complete)(simulator&, unsigned warp, std::uint64_t lanes);  ///< null for activemask
};

struct loop_frame {
    call_site at;
    std::uint64_t iteration;
};

struct lane_state {
    bool waiting = false, returned = false;
    arrival at{};
    std::vector<call_site> calls;   ///< active calls of the library, outermost first
    std::vector<loop_frame> loops;  ///< active loops over `iterations`, outermost first

    /// Returns the call site in the kernel, also for calls that the library makes.
    const call_site& kernel_site(const call_site& here) const { return calls.empty() ? here : calls.front(); }
    const call_site& site() const { return kernel_site(at.at); }

    bool meets(const lane_state& b) const {
        return waiting && b.waiting && at.mask == b.at.mask && at.value_size == b.at.value_size &&
               // mutate: call_sites_not_compared
               same(at.at.function, b.at.at.function) && same(at.at, b.at.at) && same(site(), b.site());
    }
    /// Returns whether the two lanes are in different iterations of one loop.
    bool out_of_step(const lane_state& b) const {
        for (std::size_t depth = 0; depth < loops.size() && depth < b.loops.size(); ++depth) {
            if (!same(loops[depth].at, b.loops[depth].at)) return false;
            if (loops[depth].iteration != b.loops[depth].iteration) return true;
        }
        return false;
    }
};

struct warp_state {
    static constexpr unsigned size = 64;  ///< room for this many lanes

    std::array<lane_state, size> lane;
    std::uint64_t waiting = 0;   ///< lanes that wait at a collective or in activemask
    std::uint64_t returned = 0;  ///< lanes that have returned from the kernel, or that do not exist
    std::uint64_t absent = 0;    ///< lanes that do not exist
    std::uint64_t in_barrier = 0;

    /// Vector clocks: known[a][b] is the number of synchronizations of lane b that lane a has seen.
    std::array<std::array<std::uint32_t, size>, size> known{};

    /// Makes a warp in which the first `lanes` lanes exist.
    explicit warp_state(unsigned lanes) {
        if (lanes < size) absent = returned = ~std::uint64_t{0} << lanes;
        for (unsigned a = 0; a < size; ++a) known[a][a] = 1;
    }

    bool stands() const { return (waiting | returned | in_barrier) == ~std::uint64_t{0}; }

    /// Orders all earlier accesses of these lanes before all later accesses of these lanes.
    void synchronize(std::uint64_t lanes) {
        std::array<std::uint32_t, size> all{};
        for_each_lane(lanes, [&](unsigned a) {
            for (unsigned b = 0; b < size; ++b) all[b] = std::max(all[b], known[a][b]);
        });
        for_each_lane(lanes, [&](unsigned a) {
            known[a] = all;
            ++known[a][a];  // mutate: sync_orders_what_comes_after
        });
    }
};

}  // namespace warpagg::emulator::detail
