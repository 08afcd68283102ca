// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "../../core/call_site.hpp"

namespace warpagg::emulator {

/// The rule that a kernel violated; docs/reference/diagnoses.md shows an example of each.
enum class diagnosis {
    none,                     ///< no rule was violated
    lane_not_in_mask,         ///< a lane calls a masked operation with a mask that lacks its own bit
    collective_not_reached,   ///< lanes wait for others that have returned or wait at the barrier
    different_call_sites,     ///< lanes wait for one another at different call sites
    different_masks,          ///< lanes wait for one another at one call site with different masks
    different_iterations,     ///< lanes meet in different iterations of a loop over `iterations`
    destination_not_uniform,  ///< the lanes' destinations differ
    inactive_lane_read,       ///< memory depends on a value read from a lane that took no part
    idle_warp,                ///< `assume_busy` is set, but no lane is active
    mixed_access,             ///< an atomic and a plain access to one address are not ordered
    data_race,                ///< a plain write and another plain access to one address are not ordered
    barrier_not_reached,      ///< threads wait at the barrier for a thread that has returned
    out_of_bounds,            ///< an access outside of the memory that a kernel may use
    uninitialized_read,       ///< a read of memory that nothing has written
};

/// Returns the name of a diagnosis, as in the enumeration.
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
                                     "barrier_not_reached",
                                     "out_of_bounds",
                                     "uninitialized_read"};
    return names[static_cast<unsigned>(what)];
}

/// The result of a launch.
struct report {
    diagnosis what = diagnosis::none;  ///< the violated rule
    call_site at{};                    ///< the call in the kernel that violated it
    call_site other{};                 ///< a second call that is involved; if none, `file` is null
    std::uint64_t lanes = 0;           ///< bit i is set if lane i violated the rule
    unsigned block = 0;                ///< index of the block of these lanes
    unsigned warp = 0;                 ///< index of their warp within the block
    std::string sentence;              ///< a description
    std::uint64_t seed = 0;            ///< seed of the schedule, also without a diagnosis

    /// Returns whether no rule was violated.
    bool ok() const { return what == diagnosis::none; }
    /// Returns the whole report as text, or an empty string if `ok()`.
    std::string text() const;
};

namespace detail {

/// Returns a text such as "lanes 0-3, 7".
inline std::string lanes_text(std::uint64_t lanes) {
    std::string list;
    unsigned count = 0;
    for (unsigned lane = 0; lane < 64; ++lane) {
        if (((lanes >> lane) & 1u) == 0) continue;
        unsigned last = lane;
        while (last < 63 && ((lanes >> (last + 1)) & 1u) != 0) ++last;
        list += (list.empty() ? "" : ", ") + std::to_string(lane);
        if (last > lane) list += (last > lane + 1 ? "-" : ", ") + std::to_string(last);
        count += last - lane + 1;
        lane = last;
    }
    return (count == 1 ? "lane " : "lanes ") + list;
}

/// Returns a text such as "Lanes 0-3, 7", for the start of a sentence.
inline std::string lanes_sentence(std::uint64_t lanes) {
    std::string text = lanes_text(lanes);
    text[0] = 'L';
    return text;
}

/// Returns a text such as "kernel.hpp:12, any".
inline std::string site_text(const call_site& site) {
    return std::string(site.file) + ":" + std::to_string(site.line) + ", " + site.function;
}

inline std::string hex_text(std::uint64_t bits) {
    char text[19];
    std::snprintf(text, sizeof text, "0x%08llx", static_cast<unsigned long long>(bits));
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
