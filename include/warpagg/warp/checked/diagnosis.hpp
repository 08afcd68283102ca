// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "../../core/call_site.hpp"

namespace warpagg::emulator {

/// The rule that a kernel violated; docs/unit_testing.md shows an example of each.
enum class diagnosis {
    none,                     ///< nothing
    lane_not_in_mask,         ///< a lane calls a masked operation with a mask that lacks its own bit
    collective_not_reached,   ///< some lanes wait for others that have returned or wait at the barrier
    different_call_sites,     ///< lanes wait for one another at different places
    different_masks,          ///< lanes wait for one another at one place, each with a mask of its own
    different_iterations,     ///< lanes meet at one place in different iterations of a loop over `iterations`
    destination_not_uniform,  ///< lanes name different destinations
    inactive_lane_read,       ///< memory depends on a value read from a lane that took no part
    idle_warp,                ///< `assume_busy`, but no lane is active
    mixed_access,             ///< atomic and plain accesses to one address, not ordered by a barrier or sync
    data_race,                ///< a plain write and another plain access to one address, not ordered
    barrier_not_reached,      ///< a thread has returned, and others wait for it at the barrier
};

/// The name, as in the enumeration.
inline const char* name(diagnosis what) {
    constexpr const char* names[] = {"none",
                                     "lane_not_in_mask",
                                     "collective_not_reached",
                                     "different_call_sites",
                                     "different_masks",
                                     "different_iterations",
                                     "destination_not_uniform",
                                     "inactive_lane_read",
                                     "idle_warp",
                                     "mixed_access",
                                     "data_race",
                                     "barrier_not_reached"};
    return names[static_cast<unsigned>(what)];
}

/// The result of a launch.
struct report {
    diagnosis what = diagnosis::none;  ///< the violated rule
    call_site at{};                    ///< the call in the kernel
    call_site other{};                 ///< the other call involved; `file` is null if there is none
    std::uint32_t lanes = 0;           ///< bit i: lane i violated the rule
    unsigned block = 0;                ///< of these lanes
    unsigned warp = 0;                 ///< of these lanes, within the block
    std::string sentence;              ///< a description
    std::uint64_t seed = 0;            ///< of the schedule, whether or not there was a diagnosis

    /// Whether no rule was violated.
    bool ok() const { return what == diagnosis::none; }
    /// The whole report as text; empty if ok.
    std::string text() const;
};

namespace detail {

/// "lanes 0-3, 7".
inline std::string lanes_text(std::uint32_t lanes) {
    std::string list;
    unsigned count = 0;
    for (unsigned lane = 0; lane < 32; ++lane) {
        if (((lanes >> lane) & 1u) == 0) continue;
        unsigned last = lane;
        while (last < 31 && ((lanes >> (last + 1)) & 1u) != 0) ++last;
        list += (list.empty() ? "" : ", ") + std::to_string(lane);
        if (last > lane) list += (last > lane + 1 ? "-" : ", ") + std::to_string(last);
        count += last - lane + 1;
        lane = last;
    }
    return (count == 1 ? "lane " : "lanes ") + list;
}

/// The same with a capital, to begin a sentence.
inline std::string lanes_sentence(std::uint32_t lanes) {
    std::string text = lanes_text(lanes);
    text[0] = 'L';
    return text;
}

/// "kernel.hpp:12, any".
inline std::string site_text(const call_site& site) {
    return std::string(site.file) + ":" + std::to_string(site.line) + ", " + site.function;
}

inline std::string hex_text(std::uint32_t bits) {
    char text[11];
    std::snprintf(text, sizeof text, "0x%08x", bits);
    return text;
}

inline bool same(const char* a, const char* b) { return a == b || (a && b && std::strcmp(a, b) == 0); }
inline bool same(const call_site& a, const call_site& b) { return a.line == b.line && same(a.file, b.file); }

}  // namespace detail

inline std::string report::text() const {
    if (ok()) return "";
    std::string text = std::string("warpagg: ") + name(what) + "\n";
    text += "  at " + detail::site_text(at) + "\n";
    if (other.file != nullptr) text += "  and " + detail::site_text(other) + "\n";
    text += "  " + detail::lanes_text(lanes) + " (" + detail::hex_text(lanes) + ") of warp " +
            std::to_string(warp) + " of block " + std::to_string(block) + "\n";
    text += "  " + sentence + "\n";
    text += "  replay with WARPAGG_SEED=" + std::to_string(seed) + "\n";
    return text;
}

}  // namespace warpagg::emulator
