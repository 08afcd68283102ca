// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "../ranks/communicator.hpp"
#include "../render/tiles/view_strip.hpp"
#include "../scene/camera.hpp"

namespace gs::train {

/// Divides rows into `parts` consecutive ranges with about the same sum of weights, and returns one of
/// these ranges. Ranges may be empty.
row_range balanced_rows(std::span<const std::uint64_t> weights, int part, int parts);

/// Divides each training view among the ranks. The time of a tile row depends on its work: the number
/// of splats that its pixels blend, which all ranks know from the last time.
class view_strips {
  public:
    /// Forgets all work, and sets the number of views.
    void reset(std::size_t views) { work_.assign(views, {}); }
    /// Records the work of all ranks in a view, by tile row: see `renderer::row_work`.
    void note(std::size_t view, const std::vector<std::uint64_t>& work) { work_[view] = work; }

    /// Returns the strip of this rank, or nothing if it is the only one.
    std::optional<raster::view_strip> of(std::size_t view, const camera& camera, int reach,
                                         const ranks::communicator& ranks) const;

  private:
    std::vector<std::vector<std::uint64_t>> work_;  ///< by view; empty if unknown
};

}  // namespace gs::train
