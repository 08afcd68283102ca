// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "photo_plan.hpp"

#include <algorithm>
#include <string>

#include "../core/byte_size.hpp"
#include "../core/error.hpp"
#include "packed_photo.hpp"

namespace gs::photos {
namespace {

/// While photos are in use, one is being uploaded, and one is ready.
constexpr std::size_t slots_beside = 2;

/// Each worker decodes into its own buffer, while others are uploaded from two more.
photo_plan with_workers(photo_plan plan, std::size_t workers) {
    plan.workers = workers;
    plan.staged = workers + 2;
    return plan;
}

bool fits(const photo_plan& plan, const photo_limits& limits) {
    return plan.on_host() <= limits.host && plan.on_device() <= limits.device &&
           plan.on_host() + plan.on_device() <= limits.total;
}

photo_limits half(const photo_limits& limits) { return {limits.total / 2, limits.host / 2, limits.device}; }

}  // namespace

bool any_is_streamed(std::span<const view> train, std::span<const view> held_out) {
    return std::ranges::any_of(train, &view::is_streamed) ||
           std::ranges::any_of(held_out, &view::is_streamed);
}

std::uint64_t most_resident_bytes(const photo_limits& limits) {
    // The sizes of a photo have at most 1 + 1/4 + 1/16 + ... = 4/3 times its pixels.
    return std::min({limits.total / 7 * 3, limits.host, limits.device / 4 * 3});
}

photo_plan plan_photos(std::span<const view> train, std::span<const view> held_out,
                       const photo_limits& limits, std::size_t threads, std::size_t at_once) {
    photo_plan plan{.slots = at_once + slots_beside};
    std::uint64_t all = 0, all_kept = 0;
    const view* largest = nullptr;
    for (const auto views : {train, held_out})
        for (const view& v : views) {
            const std::uint64_t bytes = packed_bytes(v.camera, v.depths.is_there());
            all += bytes;
            all_kept += kept_bytes(v);
            if (bytes > plan.photo_bytes) largest = &v;
            plan.photo_bytes = std::max(plan.photo_bytes, bytes);
            plan.worker_bytes = std::max<std::uint64_t>(plan.worker_bytes, v.decode_bytes);
        }
    plan.worker_bytes += plan.photo_bytes / 4;  // the largest of the smaller sizes
    plan = with_workers(plan, 1);
    if (!fits(plan, limits))
        throw error("--photo-memory is too small for photos such as " + largest->name +
                    ": training needs at least " + size_in_bytes(plan.on_host() + plan.on_device()));
    while (plan.workers < threads && fits(with_workers(plan, plan.workers + 1), half(limits)))
        plan = with_workers(plan, plan.workers + 1);
    const std::uint64_t left = limits.total - plan.on_host() - plan.on_device();
    const std::uint64_t host = limits.host - plan.on_host();
    const std::uint64_t device = std::min(limits.device - plan.on_device(), all);
    // If memory is short, the host gets its share first, if more photos fit there.
    const std::uint64_t first_on_host = left < all && all_kept < all ? std::min({left, host, all_kept}) : 0;
    plan.device_bytes = std::min(left - first_on_host, device);
    if (plan.device_bytes == all) return plan;
    // Photos are not divided, so the last bytes on the device may stay unused. All sizes of a photo have
    // at most 4/3 of its pixels.
    const std::uint64_t most = std::max(first_on_host, (all - plan.device_bytes + plan.photo_bytes) / 3 * 4);
    plan.host_bytes = std::min({left - plan.device_bytes, host, most});
    return plan;
}

}  // namespace gs::photos
