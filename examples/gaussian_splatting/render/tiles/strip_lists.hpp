// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "../../device/atomic.hpp"
#include "../../device/device.hpp"
#include "../geometry/list_capacity.hpp"
#include "strip_splats.hpp"
#include "tile_lists.hpp"
#include "view_strip.hpp"

namespace gs::raster {

/// Writes the length of the tile lists in each own tile row, and zero for other rows. If the capacity is
/// exceeded, all lengths are zero. Writes zero after them. One index per tile row,
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

/// Counts the instances in own tile rows if the capacity is exceeded. One index per
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

/// Moves tile lists to the places of a segment that they have in the lists of the whole view. Replaces the
/// number of instances by that of the whole view. One index per tile with a list, at least one.
template <unsigned Segment>
struct move_lists {
    const std::uint64_t* lengths;  ///< of the tile rows: see `measure_rows`
    std::size_t first_listed, rows;
    tile_range* ranges;  ///< of the tiles with lists
    std::size_t tiles;
    std::uint64_t* required;

    WARPAGG_HD void operator()(std::size_t i) const {
        std::uint64_t before = 0;
        for (std::size_t row = 0; row < first_listed; ++row) before += lengths[row];
        const auto by = static_cast<std::uint32_t>(before % Segment);
        if (i < tiles) ranges[i] = {ranges[i].begin + by, ranges[i].end + by};
        if (i > 0) return;
        for (std::size_t row = first_listed; row <= rows; ++row) before += lengths[row];
        *required = before;
    }
};

/// Where a strip is in its view, and where its tile lists go.
struct strip_place_in_view {
    row_range own, listed;  ///< tile rows
    unsigned tiles_across, tiles_down;
    std::uint64_t capacity;                  ///< largest number of instances of the whole view
    std::span<std::uint32_t> listed_splats;  ///< places for the lists, and for a segment more
    tile_range* ranges;                      ///< of all tiles of the view
    std::uint64_t* required;                 ///< receives the number of instances of the whole view

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

    /// Frees the memory, until the next `sort`.
    void release() {
        boxes_ = {};
        depths_ = {};
        order_ = {};
    }

    /// Merges the splats of a strip, and sorts them by depth.
    void sort(const strip_splats& splats, const row_range& listed) {
        const std::size_t count = splats.count();
        boxes_.resize(count);
        depths_.resize(count);
        order_.resize(count);
        device_.for_each_index(count,
                               merge_splats{splats, listed, boxes_.data(), depths_.data(), order_.data()});
        device_.sort_pairs(depths_, order_, count);
    }
    /// The boxes of the splats within the tile rows with lists, and the order of the splats.
    /// @{
    const tile_box* boxes() const { return boxes_.data(); }
    const std::uint32_t* order() const { return order_.data(); }
    /// @}
    /// The size of the arrays with a value for each splat.
    std::size_t bytes() const { return boxes_.size() * bytes_per_splat; }
    static constexpr std::size_t bytes_per_splat = sizeof(tile_box) + 2 * sizeof(std::uint32_t);

    /// Makes the lists of the splats, in their order. All ranks must call this. `items`: see
    /// `device::place_lists`; their first bucket is the first tile with a list. Lists that
    /// need more places than they have are incomplete: see `needed_places`.
    template <class Items>
    void make(const Items& items, std::size_t count, const strip_place_in_view& at) {
        place(items, count, at);
        needed_on_host_.resize(1);
        device_.begin_download(counted_, needed_on_host_.data(), at.required, 1);
        const std::size_t first_listed = at.first_tile(at.listed);
        const list_capacity capacity{at.required, at.capacity};
        lengths_.resize(at.tiles_down + 1);
        device_.for_each_index(lengths_.size(), measure_rows{at.ranges, at.tiles_across, at.own,
                                                             at.tiles_down, capacity, lengths_.data()});
        const auto first = static_cast<std::uint32_t>(at.first_tile(at.own) - first_listed);
        const auto last = static_cast<std::uint32_t>(first + at.tiles(at.own));
        device_.for_each_index(
            count, count_unlisted<Items>{items, first, last, capacity, lengths_.data() + at.tiles_down});
        // Ranks meet here, before the lists are written, because these take the ranks different times.
        device_.sum_over_ranks(lengths_.data(), lengths_.size());
        write(items, count, at);
    }
    /// Makes the same lists again, after `make` and with memory for them. Other ranks need not call it.
    template <class Items>
    void make_again(const Items& items, std::size_t count, const strip_place_in_view& at) {
        place(items, count, at);
        write(items, count, at);
    }
    /// Returns the number of instances in the lists, or `capacity` if there are more. Waits until the device
    /// has counted them, but not for later work, so that it stays busy.
    std::uint64_t needed_places(std::uint64_t capacity) {
        counted_.wait();
        return std::min(*needed_on_host_.data(), capacity);
    }

  private:
    template <class Items>
    void place(const Items& items, std::size_t count, const strip_place_in_view& at) {
        device_.place_lists(count, items, at.tiles(at.listed), at.capacity,
                            at.ranges + at.first_tile(at.listed), at.required);
    }
    template <class Items>
    void write(const Items& items, std::size_t count, const strip_place_in_view& at) {
        const std::size_t buckets = at.tiles(at.listed);
        tile_range* const ranges = at.ranges + at.first_tile(at.listed);
        device_.for_each_index(std::max<std::size_t>(buckets, 1),
                               move_lists<Segment>{lengths_.data(), static_cast<std::size_t>(at.listed.first),
                                                   at.tiles_down, ranges, buckets, at.required});
        device_.write_lists(count, items, buckets, at.listed_splats.size(), at.listed_splats.data(), ranges);
    }

    Device& device_;
    buffer<tile_box> boxes_;
    buffer<std::uint32_t> depths_, order_;
    buffer<std::uint64_t> lengths_;
    typename Device::template host_buffer<std::uint64_t> needed_on_host_;
    typename Device::transfer counted_;
};

}  // namespace gs::raster
