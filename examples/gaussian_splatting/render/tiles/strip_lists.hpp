// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../device/atomic.hpp"
#include "../../device/device.hpp"
#include "../geometry/list_capacity.hpp"
#include "tile_lists.hpp"
#include "view_strip.hpp"

namespace gs::raster {

/// Writes the length of the tile lists in each own tile row, and zero for other rows. If the lists do
/// not fit into their memory, all lengths are zero. Writes zero after them. One index per tile row,
/// and one more.
struct measure_rows {
    const tile_range* ranges;
    std::size_t tiles_across;
    row_range own;
    std::size_t rows;  ///< number of all tile rows
    list_capacity capacity;
    std::uint64_t* lengths;

    WARPAGG_HD void operator()(std::size_t row) const {
        const bool is_own = static_cast<int>(row) >= own.first && static_cast<int>(row) < own.last;
        lengths[row] = row < rows && is_own && !capacity.exceeded()
                           ? ranges[(row + 1) * tiles_across - 1].end - ranges[row * tiles_across].begin
                           : 0;
    }
};

/// Counts the instances in own tile rows if the lists do not fit into their memory. One index per
/// item: see `device::items`.
template <class Items>
struct count_unlisted {
    Items items;
    std::uint32_t first_tile, last_tile;
    list_capacity capacity;
    std::uint64_t* number;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (!capacity.exceeded()) return;
        const auto item = items(i);
        unsigned long long found = 0;
        for (std::uint32_t k = 0; k < item.size(); ++k) {
            const std::uint32_t tile = item.bucket(k);
            if (tile >= first_tile && tile < last_tile) ++found;
        }
        device::atomic_add(reinterpret_cast<unsigned long long*>(number), found);
    }
};

/// Where the lists of a strip are among the lists of the whole view.
struct strip_place {
    unsigned long long all;     ///< number of instances of the whole view
    unsigned long long before;  ///< number of instances in the tile rows before those with lists
    std::uint64_t listed;       ///< number of instances in the lists of the strip
};

/// Adds the lengths of tile rows to the place. One index per length that `measure_rows` writes.
struct add_rows {
    const std::uint64_t* lengths;
    std::size_t first_listed;
    strip_place* place;  ///< initially zero

    WARPAGG_HD void operator()(std::size_t row) const {
        if (lengths[row] == 0) return;
        device::atomic_add(&place->all, static_cast<unsigned long long>(lengths[row]));
        if (row < first_listed)
            device::atomic_add(&place->before, static_cast<unsigned long long>(lengths[row]));
    }
};

/// Replaces the number of listed instances by that of the whole view. One index.
struct require_all {
    strip_place* place;
    std::uint64_t* required;

    WARPAGG_HD void operator()(std::size_t) const {
        place->listed = *required;
        *required = place->all;
    }
};

/// Moves tile lists to the places of a segment that they have in the lists of the whole view. One
/// index per thread.
template <unsigned Segment>
struct move_lists {
    const strip_place* place;
    const std::uint32_t* from;
    std::uint32_t* to;
    std::uint64_t capacity;
    std::size_t threads;
    tile_range* ranges;  ///< of the tiles with lists
    std::size_t tiles;

    WARPAGG_HD void operator()(std::size_t thread) const {
        const auto by = static_cast<std::uint32_t>(place->before % Segment);
        const std::uint64_t listed = place->listed < capacity ? place->listed : capacity;
        for (std::size_t i = thread; i < tiles; i += threads)
            ranges[i] = {ranges[i].begin + by, ranges[i].end + by};
        for (std::size_t i = thread; i < listed; i += threads) to[i + by] = from[i];
    }
};

/// Where a strip is in its view, and where its tile lists go.
struct strip_place_in_view {
    row_range own, listed;  ///< tile rows
    unsigned tiles_across, tiles_down;
    std::uint64_t capacity;  ///< of `listed_splats`
    std::uint32_t* listed_splats;
    tile_range* ranges;       ///< of all tiles of the view
    std::uint64_t* required;  ///< receives the number of instances of the whole view

    std::size_t first_tile(const row_range& rows) const {
        return static_cast<std::size_t>(rows.first) * tiles_across;
    }
    std::size_t tiles(const row_range& rows) const {
        return static_cast<std::size_t>(rows.count()) * tiles_across;
    }
};

/// Makes the tile lists of a strip. Lists begin at the same place of a segment as in the lists of a whole
/// view, so that the backward pass cuts them at the same places and computes the same bits.
template <device::device Device, unsigned Segment>
class strip_lists {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit strip_lists(Device& device) : device_(device) {}

    /// Frees the memory, until the next `clip`.
    void release() {
        boxes_ = {};
        unmoved_ = {};
    }

    /// Limits the boxes of splats to the tile rows with lists: see `clip_boxes`. Returns the new boxes.
    const buffer<tile_box>& clip(const tile_box* boxes, std::uint32_t* depths, std::size_t count,
                                 const row_range& listed) {
        boxes_.resize(count);
        device_.for_each_index(count, clip_boxes{boxes, listed, boxes_.data(), depths});
        return boxes_;
    }
    /// Makes the lists of the splats, in their order. All ranks must call this. `items`: see
    /// `device::distribute`.
    template <class Items>
    void make(const Items& items, std::size_t count, const strip_place_in_view& at) {
        unmoved_.resize(at.capacity);
        device_.distribute(count, items, at.tiles({0, static_cast<int>(at.tiles_down)}), at.capacity,
                           unmoved_.data(), at.ranges, at.required);
        const list_capacity capacity{at.required, at.capacity};
        lengths_.resize(at.tiles_down + 1);
        device_.for_each_index(lengths_.size(), measure_rows{at.ranges, at.tiles_across, at.own,
                                                             at.tiles_down, capacity, lengths_.data()});
        const auto first = static_cast<std::uint32_t>(at.first_tile(at.own));
        const auto last = static_cast<std::uint32_t>(first + at.tiles(at.own));
        device_.for_each_index(
            count, count_unlisted<Items>{items, first, last, capacity, lengths_.data() + at.tiles_down});
        device_.sum_over_ranks(lengths_.data(), lengths_.size());
        place_.resize(1);
        device_.zero(place_.data(), 1);
        device_.for_each_index(
            lengths_.size(),
            add_rows{lengths_.data(), static_cast<std::size_t>(at.listed.first), place_.data()});
        device_.for_each_index(1, require_all{place_.data(), at.required});
        const std::size_t threads = 32 * device_.resident_warps();
        device_.for_each_index(
            threads, move_lists<Segment>{place_.data(), unmoved_.data(), at.listed_splats, at.capacity,
                                         threads, at.ranges + at.first_tile(at.listed), at.tiles(at.listed)});
    }

  private:
    Device& device_;
    buffer<tile_box> boxes_;
    buffer<std::uint32_t> unmoved_;
    buffer<std::uint64_t> lengths_;
    buffer<strip_place> place_;
};

}  // namespace gs::raster
