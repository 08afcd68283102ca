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

/// Divides each training view among the ranks. The time of a tile row depends on the length of its tile
/// lists, of which the last ones of the view are known to all ranks.
class view_strips {
  public:
    /// Forgets all lengths, and sets the number of views.
    void reset(std::size_t views) { lengths_.assign(views, {}); }
    /// Records the lengths of a view's tile rows: see `renderer::row_lengths`.
    void note(std::size_t view, const std::vector<std::uint64_t>& lengths) { lengths_[view] = lengths; }

    /// Returns the strip of this rank, or nothing if it is the only one.
    std::optional<raster::view_strip> of(std::size_t view, const camera& camera, int reach,
                                         const ranks::communicator& ranks) const;

  private:
    std::vector<std::vector<std::uint64_t>> lengths_;  ///< by view; empty if unknown
};

}  // namespace gs::train
