// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../device/device.hpp"
#include "../render/tiles/tile_reach.hpp"
#include "view_strips.hpp"

namespace gs::train {

/// Collects the lengths of the tile rows of each view on the device, so that no step waits for them.
template <device::device Device>
class strip_lengths {
  public:
    explicit strip_lengths(Device& device) : device_(device) {}

    /// Forgets all lengths. `heights`: the number of pixel rows of each view.
    void reset(const std::vector<int>& heights) {
        first_row_.assign(1, 0);
        for (const int height : heights)
            first_row_.push_back(
                first_row_.back() +
                static_cast<std::size_t>((height + raster::tile_size - 1) / raster::tile_size));
        is_new_.assign(heights.size(), false);
    }
    /// Keeps the lengths of a view: see `renderer::row_lengths`.
    void keep(std::size_t view, std::span<const std::uint64_t> lengths) {
        lengths_.resize(first_row_.back());
        device_.copy(lengths_.data() + first_row_[view], lengths.data(), lengths.size());
        is_new_[view] = true;
    }
    /// Passes the lengths of all views that have new ones to `strips`. Waits for the device.
    void take(view_strips& strips) {
        if (std::ranges::find(is_new_, true) == is_new_.end()) return;
        std::vector<std::uint64_t> all(lengths_.size());
        device_.download(all.data(), lengths_.data(), all.size());
        for (std::size_t view = 0; view < is_new_.size(); ++view) {
            if (!is_new_[view]) continue;
            const auto begin = all.begin();
            strips.note(view, {begin + static_cast<std::ptrdiff_t>(first_row_[view]),
                               begin + static_cast<std::ptrdiff_t>(first_row_[view + 1])});
            is_new_[view] = false;
        }
    }

  private:
    Device& device_;
    typename Device::template buffer<std::uint64_t> lengths_;
    std::vector<std::size_t> first_row_;  ///< where the lengths of each view begin
    std::vector<bool> is_new_;
};

}  // namespace gs::train
