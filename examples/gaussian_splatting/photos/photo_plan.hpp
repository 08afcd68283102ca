// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "../scene/scene.hpp"

namespace gs::photos {

/// Limits of the memory for decoded photos, in bytes.
struct photo_limits {
    static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t total = none;  ///< host and device together
    std::uint64_t host = none;
    std::uint64_t device = none;
};

/// The memory for photos that stay in their files during training.
struct photo_plan {
    std::size_t workers = 0;         ///< threads that decode
    std::size_t staged = 0;          ///< photos in host memory that wait for their upload
    std::size_t slots = 0;           ///< photos in device memory that later ones replace
    std::uint64_t photo_bytes = 0;   ///< size of the largest packed photo
    std::uint64_t worker_bytes = 0;  ///< largest size of the images that one worker holds
    std::uint64_t host_bytes = 0;    ///< for photos that stay in host memory
    std::uint64_t device_bytes = 0;  ///< for photos that stay in device memory

    std::uint64_t on_host() const { return workers * worker_bytes + staged * photo_bytes + host_bytes; }
    std::uint64_t on_device() const { return slots * photo_bytes + device_bytes; }
};

/// Returns whether a view is streamed. Then all are.
bool any_is_streamed(std::span<const view> train, std::span<const view> held_out);

/// Returns the largest size of all photos, of one copy in full size, that training can keep in
/// memory within the limits. The host keeps one copy, and the device one copy of each size.
std::uint64_t most_resident_bytes(const photo_limits& limits);

/// Divides the memory for streamed views. Decoding gets at most half of it, for up to `threads`
/// workers. `at_once`: the number of photos that a step needs. The photos that stay in device memory get the
/// remaining memory of the device, and those in host memory get the rest. If there is not enough memory for
/// all photos, and photos take fewer bytes on the host, the host gets its share first. Throws `error` with
/// the smallest sufficient limit if the limits are too small.
photo_plan plan_photos(std::span<const view> train, std::span<const view> held_out,
                       const photo_limits& limits, std::size_t threads, std::size_t at_once = 1);

}  // namespace gs::photos
