// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../device/device.hpp"
#include "gradients/gradient_sums.hpp"
#include "project/splat_exchange.hpp"
#include "tiles/segments.hpp"
#include "tiles/strip_lists.hpp"

namespace gs::raster {

/// The sizes of a renderer's memory in bytes, for forecasts.
template <device::device Device, class Real, class Cut>
struct renderer_bytes {
    static constexpr std::size_t per_gaussian(accumulator how) {
        return sizeof(splat<Real>) + sizeof(tile_box) + 3 * sizeof(std::uint32_t) +
               gradient_sums<Device, Real>::bytes_per_gaussian(how);
    }
    /// Per pair of Gaussian and tile.
    static constexpr std::size_t per_instance() {
        return sizeof(std::uint32_t) +
               (checkpoint_values * sizeof(Real) + sizeof(std::uint32_t)) / Cut::segment;
    }
    static constexpr std::size_t per_pixel() {
        constexpr std::size_t of_tile = checkpoint_values * sizeof(Real) + sizeof(tile_range);
        return 4 * sizeof(Real) + sizeof(std::uint32_t) + of_tile / (tile_size * tile_size);
    }
    /// Per splat that a rank gets from others.
    static constexpr std::size_t per_received(accumulator how) {
        return sizeof(splat<Real>) + gradient_sums<Device, Real>::bytes_per_gaussian(how);
    }
    /// Per Gaussian that one of a few ranks owns and sends once, beyond `per_gaussian`.
    static constexpr std::size_t per_sent_splat(accumulator how) {
        constexpr std::size_t ranks = 4, of_mark = sizeof(std::uint32_t) + sizeof(std::uint64_t);
        return strip_lists<Device, Cut::segment>::bytes_per_splat + (ranks + 1) * of_mark +
               record_stride * sizeof(std::uint64_t) + 2 * sizeof(splat_reach) + per_received(how);
    }
};

}  // namespace gs::raster
