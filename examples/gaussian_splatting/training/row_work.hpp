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

/// Collects the work of the tile rows of each view on the device, so that no step waits for it: see
/// `renderer::row_work`.
template <device::device Device>
class row_work {
  public:
    explicit row_work(Device& device) : device_(device) {}

    /// Forgets the work, and sets the views: a range of objects with a `camera`.
    template <class Views>
    void reset(const Views& views) {
        first_row_.assign(1, 0);
        for (const auto& view : views)
            first_row_.push_back(
                first_row_.back() +
                static_cast<std::size_t>((view.camera.height + raster::tile_size - 1) / raster::tile_size));
        is_new_.assign(views.size(), false);
    }
    /// Keeps the work of this rank in a view. `work` begins with the first row of this view.
    void keep(std::size_t view, std::span<const unsigned long long> work) {
        work_.resize(first_row_.back());
        device_.copy(work_.data() + first_row_[view], work.data(), first_row_[view + 1] - first_row_[view]);
        is_new_[view] = true;
    }
    /// Passes the work of all ranks in views that were drawn since the last call to `strips`. All
    /// ranks must call this. Waits for the device.
    void take(view_strips& strips) {
        if (std::ranges::find(is_new_, true) == is_new_.end()) return;
        std::vector<unsigned long long> of_rank(work_.size());
        device_.download(of_rank.data(), work_.data(), of_rank.size());
        std::vector<std::uint64_t> all(of_rank.begin(), of_rank.end());
        device_.ranks().sum(all.data(), all.size());
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
    typename Device::template buffer<unsigned long long> work_;
    std::vector<std::size_t> first_row_;  ///< where the rows of each view begin
    std::vector<bool> is_new_;
};

}  // namespace gs::train
