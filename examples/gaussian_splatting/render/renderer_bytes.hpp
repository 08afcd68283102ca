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
    static constexpr std::size_t per_received_splat() {
        return sizeof(splat<Real>) + record_stride * sizeof(Real);
    }
    /// Per Gaussian that a rank owns and sends once, beyond `per_gaussian`.
    static constexpr std::size_t per_sent_splat() {
        return strip_lists<Device, Cut::segment>::bytes_per_splat + sizeof(splat<Real>) +
               2 * sizeof(splat_reach) + per_received_splat();
    }
};

}  // namespace gs::raster
