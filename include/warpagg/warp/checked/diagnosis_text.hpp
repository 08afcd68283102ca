// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Functions that describe violations in sentences.

#include <bit>
#include <cstdint>
#include <string>

#include "diagnosis.hpp"
#include "lane.hpp"
#include "shadow_memory.hpp"
#include "undefined.hpp"

namespace warpagg::emulator::detail {

struct violation {
    diagnosis what;
    call_site at, other;
    std::uint64_t lanes;
    std::string sentence;
};

inline constexpr const char* does[] = {"reads", "writes", "updates atomically"};  // by access_kind

inline violation not_in_mask(const lane_state& self, const arrival& a, std::uint64_t lane) {
    return {diagnosis::lane_not_in_mask,
            self.kernel_site(a.at),
            {},
            lane,
            lanes_sentence(lane) + " calls " + a.at.function + " with the mask " + hex_text(a.mask) +
                ", which lacks its own bit."};
}

inline violation out_of_step(const call_site& at, std::uint64_t lanes, std::uint64_t others) {
    return {diagnosis::different_iterations,
            at,
            {},
            lanes,
            lanes_sentence(lanes) + " and " + lanes_text(others) + " meet in " + at.function +
                " in different iterations of a loop."};
}

/// Describes a warp in which no lane can continue and some lanes wait for others.
inline violation stuck(const warp_state& w) {
    const lane_state& first = w.lane[first_of(w.waiting)];
    std::uint64_t here = 0;
    for_each_lane(w.waiting, [&](unsigned lane) { here |= first.meets(w.lane[lane]) ? bit_of(lane) : 0u; });
    const std::uint64_t missing = (first.at.all_lanes ? first.at.mask : first.at.mask & ~w.returned) & ~here;
    const call_site& at = first.site();
    const std::string waiting =
        lanes_sentence(here) + (std::popcount(here) == 1 ? " waits for " : " wait for ");

    if (const std::uint64_t never = missing & ~w.waiting; never != 0) {
        std::string why;
        const auto add = [&](std::uint64_t lanes, const char* what) {
            if (lanes != 0) why += (why.empty() ? "" : ", and ") + lanes_text(lanes) + what;
        };
        add(never & w.absent, " do not exist in this block");
        add(never & w.returned & ~w.absent, " returned");
        add(never & w.in_barrier, " went to the barrier");
        const bool left = (never & w.returned & ~w.absent) != 0;
        return {diagnosis::collective_not_reached,
                at,
                {},
                never,
                waiting + lanes_text(never) + " in " + at.function + ", but " + why + "." +
                    (left ? " A likely cause is a continue, break or return before the call." : "")};
    }
    const lane_state& other = w.lane[first_of(missing)];
    if (same(first.at.at, other.at.at) && same(at, other.site()) && first.at.mask != other.at.mask)
        return {diagnosis::different_masks,
                at,
                {},
                missing,
                lanes_sentence(here) + " and " + lanes_text(missing) + " meet in " + at.function +
                    " with different masks, " + hex_text(first.at.mask) + " and " + hex_text(other.at.mask) +
                    "."};
    return {diagnosis::different_call_sites, at, other.site(), missing,
            waiting + lanes_text(missing) + " in " + at.function + ", but " +
                (std::popcount(missing) == 1 ? "that is in " : "those are in ") + other.site().function +
                " at another place."};
}

inline violation not_uniform(const call_site& at, std::uint64_t lanes, unsigned first) {
    return {diagnosis::destination_not_uniform,
            at,
            {},
            lanes,
            "All lanes must name one record, but that of " + lanes_text(lanes) + " is not that of lane " +
                std::to_string(first) + ". A likely cause is a continue or an early return before the call."};
}

inline violation idle_warp(const call_site& at, std::uint64_t lanes) {
    return {diagnosis::idle_warp, at, {}, lanes, "The policy says assume_busy, but no lane is active."};
}

inline violation barrier_not_reached(const call_site& at, std::uint64_t returned, unsigned in_barrier,
                                     unsigned threads) {
    return {diagnosis::barrier_not_reached,
            at,
            {},
            returned,
            std::to_string(in_barrier) + " of the block's " + std::to_string(threads) +
                " threads wait at the barrier, but " + lanes_text(returned) +
                " of this warp returned without it."};
}

inline violation another_barrier(const call_site& at, const call_site& other, std::uint64_t lanes) {
    return {diagnosis::different_call_sites, at, other, lanes,
            lanes_sentence(lanes) + " of this warp went to the barrier at another place."};
}

/// Describes an access of `size` bytes; `where` completes the sentence "Lane 3 reads 4 bytes ...".
inline violation out_of_bounds(const call_site& at, unsigned lane, access_kind kind, std::size_t size,
                               const std::string& where) {
    return {diagnosis::out_of_bounds,
            at,
            {},
            bit_of(lane),
            "Lane " + std::to_string(lane) + " " + does[static_cast<unsigned>(kind)] + " " +
                std::to_string(size) + " bytes " + where + "."};
}
inline violation bad_index(const call_site& at, unsigned lane, const std::string& index,
                           const std::string& array) {
    return {
        diagnosis::out_of_bounds,
        at,
        {},
        bit_of(lane),
        "Lane " + std::to_string(lane) + " uses the index " + index + " of an array of type " + array + "."};
}
inline violation uninitialized_read(const call_site& at, unsigned lane, bool shared) {
    return {diagnosis::uninitialized_read,
            at,
            {},
            bit_of(lane),
            "Lane " + std::to_string(lane) + " reads " +
                (shared ? "shared memory that no thread of its block has written."
                        : "an element of an array that nothing has written.")};
}

/// Describes two accesses by threads of a block with warps of `width` lanes.
inline violation conflict(const access& before, const access& now, unsigned width) {
    constexpr const char* did[] = {"read", "wrote", "updated atomically"};
    const bool mixed = (before.kind == access_kind::atomic) != (now.kind == access_kind::atomic);
    const bool same_warp = before.block == now.block && before.thread / width == now.thread / width;
    std::string other = "lane " + std::to_string(before.thread % width);
    if (!same_warp) other += " of warp " + std::to_string(before.thread / width);
    if (before.block != now.block) other += " of block " + std::to_string(before.block);
    return {mixed ? diagnosis::mixed_access : diagnosis::data_race, now.at, before.at,
            bit_of(now.thread % width) | (same_warp ? bit_of(before.thread % width) : 0u),
            "Lane " + std::to_string(now.thread % width) + " " + does[static_cast<unsigned>(now.kind)] +
                " what " + other + " " + did[static_cast<unsigned>(before.kind)] +
                (before.block == now.block ? ", with no barrier or sync between."
                                           : ", and nothing orders blocks of one launch.")};
}

/// Describes a write at `at` that depends on the undefined value that `lane` got by `read`.
inline violation inactive_lane_read(const undefined_read& read, unsigned lane, const call_site& at) {
    return {diagnosis::inactive_lane_read, at, read.at, bit_of(lane),
            "What is written depends on what lane " + std::to_string(lane) + " read from lane " +
                std::to_string(read.from) + ", which took no part."};
}

}  // namespace warpagg::emulator::detail
