// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "../ranks/communicator.hpp"
#include "../render/tiles/view_stack.hpp"
#include "../render/tiles/view_strip.hpp"

namespace gs::train {

/// Divides rows into `parts` consecutive ranges with about the same sum of weights, and returns one of
/// these ranges. Ranges may be empty.
row_range balanced_rows(std::span<const std::uint64_t> weights, int part, int parts);

/// Divides each training view among the ranks. The time of a tile row depends on its work when the view was
/// drawn before: see `raster::measure_work`. All ranks know it. They also know how many splats they sent each
/// other, so that a step need not wait for these numbers.
class view_strips {
  public:
    /// Forgets all work and splats, and sets the number of views.
    void reset(std::size_t views) {
        work_.assign(views, {});
        sent_.assign(views, {});
    }
    /// Records the work of all ranks in a view, by tile row: see `renderer::row_work`.
    void note(std::size_t view, const std::vector<std::uint64_t>& work) {
        if (work_[view].empty()) sent_[view] = {};  // the borders move far
        work_[view] = work;
    }
    /// Records the numbers of splats that ranks with these shares of the Gaussians have sent each other for a
    /// view: see `splat_exchange::window_counts`.
    void note_sent(std::size_t view, const std::vector<std::size_t>& counts, const ranks::shares& gaussians) {
        sent_[view] = {counts, gaussians};
    }

    /// Returns the strip of this rank in a picture of these views, or nothing if it is the only rank and
    /// there is one view.
    std::optional<raster::view_strip> of(std::span<const std::size_t> views,
                                         const raster::view_stack& picture, int reach,
                                         const ranks::communicator& ranks) const;
    /// The same for a step with these shares of the Gaussians: with the windows that the ranks expect.
    std::optional<raster::view_strip> of_step(std::span<const std::size_t> views,
                                              const raster::view_stack& picture, int reach,
                                              const ranks::communicator& ranks,
                                              const ranks::shares& gaussians) const;

  private:
    /// Returns the expected work of each tile row of a picture.
    std::vector<std::uint64_t> work_of_rows(std::span<const std::size_t> views,
                                            const raster::view_stack& picture) const;
    /// Returns windows that probably have places for all splats of a view, or nothing if none are recorded.
    std::optional<ranks::windows> windows(std::size_t view, const ranks::shares& gaussians) const;

    struct sent_splats {
        std::vector<std::size_t> counts;
        ranks::shares gaussians{0, 1, 1};
    };

    std::vector<std::vector<std::uint64_t>> work_;  ///< by view; empty if unknown, like the next
    std::vector<sent_splats> sent_;
};

}  // namespace gs::train
