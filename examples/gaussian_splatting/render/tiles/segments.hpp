// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <type_traits>
#include <warpagg/warp/concept.hpp>

#include "tile_lists.hpp"

namespace gs::raster {

/// Divides a view among warps. The lanes of a warp are `Across` pixels wide, each lane has `Rows`
/// pixels of a column (see `patch`), and a segment has `Segment` places of the sorted list. The
/// backward pass splits a long list over several warps: lists are cut where a place is a multiple
/// of `Segment`, and the forward pass stores the state of the pixels there. `Sparse`: skips single
/// rows of a patch that do not see a splat, at the cost of a vote and a branch each. `Panorama`:
/// the left and the right border of the view are the same place.
template <unsigned Across, unsigned Rows, unsigned Segment, bool Sparse = false, bool Panorama = false>
struct cut {
    static constexpr unsigned across = Across, rows = Rows, segment = Segment;
    static constexpr bool sparse = Sparse, panorama = Panorama;
};

/// The division for the warps of a device. Source: measurements with `lab backward`.
template <class W>
using cut_for = std::conditional_t<W::size == 1, cut<1, 1, 128>,
                                   // knob: segment_cut
                                   std::conditional_t<W::size == 8, cut<8, 16, 1024, true>, cut<8, 2, 128>>>;
/// Returns the same division with one pixel per lane.
template <class Cut>
using pixel_a_lane = cut<Cut::across, 1, Cut::segment, false, Cut::panorama>;
/// Returns the same division with lower patches, for views with too few patches to keep a device
/// busy.
template <class Cut>
using lower = std::conditional_t<Cut::sparse, cut<Cut::across, 8, Cut::segment, true, Cut::panorama>,
                                 pixel_a_lane<Cut>>;
/// Returns the same division of a panorama.
template <class Cut>
using panorama_cut = cut<Cut::across, Cut::rows, Cut::segment, Cut::sparse, true>;

/// Returns an upper bound of segment numbers. The segment of a place in the list of tile t has the
/// number t + place / Segment; not every number is used.
template <class Cut>
constexpr std::size_t most_segments(std::size_t tiles, std::size_t places) {
    return tiles + places / Cut::segment;
}

/// Finds the tile of each segment. One index per segment.
template <class Cut>
struct number_segments {
    const tile_range* ranges;
    std::uint32_t tiles;
    std::uint32_t* tile_of;      ///< the tile plus one, or zero if the number is not used
    std::uint32_t first_tile{};  ///< segments of tiles before this one count as not used

    WARPAGG_HD void operator()(std::size_t index) const {
        const auto segment = static_cast<std::uint32_t>(index);
        std::uint32_t tile = first_tile, end = tiles;  // finds the last tile with first segment <= segment
        while (end - tile > 1) {
            const std::uint32_t middle = tile + (end - tile) / 2;
            (middle + ranges[middle].begin / Cut::segment <= segment ? tile : end) = middle;
        }
        const tile_range r = ranges[tile];
        const bool is_there = r.begin < r.end && segment >= tile + r.begin / Cut::segment &&
                              segment - tile <= (r.end - 1) / Cut::segment;
        tile_of[segment] = is_there ? tile + 1 : 0;
    }
};

/// Number of values in the checkpoint of a segment.
inline constexpr std::size_t checkpoint_values = 4 * tile_size * tile_size;

/// The state of a tile's pixels at the beginning of a segment: transmittance and color. The forward
/// pass writes it, and the backward pass of the segment before begins with it. It is stored in
/// blocks of one pixel per lane, so that patches of one width and any height share the layout.
template <class W, class Real, class Patch>
class checkpoint {
  public:
    using real = warpagg::value_t<W, Real>;

    WARPAGG_HD checkpoint(Real* all, std::size_t segment, unsigned in_tile)
        : at_(all + segment * checkpoint_values +
              (in_tile / Patch::per_row * Patch::rows * Patch::per_row + in_tile % Patch::per_row) * block) {}

    /// Writes or reads the block in row k of the patch.
    /// @{
    WARPAGG_HD void store(const W& w, unsigned k, const real (&state)[4]) const {
        for (unsigned i = 0; i < 4; ++i) w.store_row(at_, place(k, i), state[i], true);
    }
    WARPAGG_HD void load(const W& w, unsigned k, real (&state)[4]) const {
        for (unsigned i = 0; i < 4; ++i) state[i] = w.load_row(at_, place(k, i));
    }
    /// @}

  private:
    static constexpr unsigned block = 4 * W::size;  ///< values of a block
    static WARPAGG_HD std::ptrdiff_t place(unsigned k, unsigned i) {
        return static_cast<std::ptrdiff_t>(k * Patch::per_row * block + i * W::size);
    }

    Real* at_;
};

}  // namespace gs::raster
