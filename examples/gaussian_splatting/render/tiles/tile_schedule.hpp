// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../device/device.hpp"
#include "segments.hpp"
#include "tile_order.hpp"

namespace gs::raster {

/// The order in which warps draw the tiles of a view, and the segments of its tile lists.
template <device::device Device>
class tile_schedule {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit tile_schedule(Device& device) : device_(device) {}

    /// Orders the tiles [`listed.first`, `listed.last`) of a view with `tiles` tiles, and numbers the
    /// segments of the tiles in `own`. `segments`: the largest number of segments.
    template <class Cut>
    void make(const tile_range* ranges, std::size_t tiles, const ranks::share& listed,
              const ranks::share& own, std::size_t segments) {
        tiles_ = tiles;
        tile_of_segment_.resize(segments);
        device_.for_each_index(
            segments, number_segments<Cut>{ranges, static_cast<std::uint32_t>(own.last),
                                           tile_of_segment_.data(), static_cast<std::uint32_t>(own.first)});
        counts_.resize(tile_order::classes);
        ordered_.resize(tile_order::classes * tiles);
        device_.zero(counts_.data(), counts_.size());
        device_.for_each_index(listed.count(), order_tiles{ranges, order(), listed.first});
    }

    tile_order order() const { return {counts_.data(), ordered_.data(), static_cast<std::uint32_t>(tiles_)}; }
    /// See `number_segments`.
    const std::uint32_t* tile_of_segment() const { return tile_of_segment_.data(); }

  private:
    Device& device_;
    std::size_t tiles_ = 0;
    buffer<std::uint32_t> tile_of_segment_, counts_, ordered_;
};

}  // namespace gs::raster
