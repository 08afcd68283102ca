// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "view_strips.hpp"

#include <algorithm>
#include <numeric>

namespace gs::train {

row_range balanced_rows(std::span<const std::uint64_t> weights, int part, int parts) {
    const std::uint64_t all = std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
    // A row belongs to the part in which its middle lies.
    const auto rows_before = [&](int p) {
        const std::uint64_t border =
            2 * all / static_cast<std::uint64_t>(parts) * static_cast<std::uint64_t>(p);
        std::uint64_t before = 0;
        int row = 0;
        for (const std::uint64_t weight : weights) {
            if (p < parts && 2 * before + weight >= border) break;
            before += weight;
            ++row;
        }
        return row;
    };
    return {part == 0 ? 0 : rows_before(part), rows_before(part + 1)};
}

std::vector<std::uint64_t> view_strips::work_of_rows(std::span<const std::size_t> views,
                                                     const raster::view_stack& picture) const {
    // The time for a pixel without splats is about that for 16 splats.
    constexpr std::uint64_t work_of_tile = 16 * raster::samples_per_tile;
    const auto in_tiles = [](int pixels) {
        return static_cast<std::size_t>((pixels + raster::tile_size - 1) / raster::tile_size);
    };
    std::vector<std::uint64_t> work(picture.tiles_down());
    for (std::size_t v = 0; v < views.size(); ++v) {
        const std::size_t first = v * picture.tiles_of_view(), rows = in_tiles(picture[v].height);
        const bool is_known = views[v] < work_.size() && work_[views[v]].size() == rows;
        for (std::size_t row = 0; row < rows; ++row)
            work[first + row] =
                in_tiles(picture[v].width) * work_of_tile + (is_known ? work_[views[v]][row] : 0);
    }
    return work;
}

std::optional<raster::view_strip> view_strips::of(std::span<const std::size_t> views,
                                                  const raster::view_stack& picture, int reach,
                                                  const ranks::communicator& ranks) const {
    if (ranks.count() == 1 && views.size() == 1) return {};
    const std::vector<std::uint64_t> work = work_of_rows(views, picture);
    raster::view_strip strip{{}, reach};
    for (int rank = 0; rank < ranks.count(); ++rank)
        strip.own_of_all.push_back(balanced_rows(work, rank, ranks.count()));
    strip.own = strip.own_of_all[static_cast<std::size_t>(ranks.rank())];
    return strip;
}

std::optional<raster::view_strip> view_strips::of_step(std::span<const std::size_t> views,
                                                       const raster::view_stack& picture, int reach,
                                                       const ranks::communicator& ranks,
                                                       const ranks::shares& gaussians) const {
    auto strip = of(views, picture, reach, ranks);
    if (!strip) return {};
    if (ranks.count() == 1)
        strip->windows = ranks::windows(std::vector<std::size_t>{0}, 1);
    else if (views.size() == 1)  // the borders in a picture of several views depend on all of them
        strip->windows = windows(views[0], gaussians);
    return strip;
}

std::optional<ranks::windows> view_strips::windows(std::size_t view, const ranks::shares& gaussians) const {
    if (view >= sent_.size() || sent_[view].counts.empty()) return {};
    // Training changes the numbers a little, and they grow with the shares of the model. Too few places cost
    // more time than some unused ones.
    constexpr double reserve = 1.0 / 16;
    constexpr std::size_t least = 64;
    const std::vector<std::size_t>& counts = sent_[view].counts;
    std::vector<std::size_t> places(counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const auto ranks = static_cast<std::size_t>(gaussians.ranks()), from = i / ranks, to = i % ranks;
        if (from == to) continue;  // a rank sends itself nothing
        const auto rank = static_cast<int>(from);
        const auto now = static_cast<double>(gaussians.of(rank).count()),
                   before =
                       static_cast<double>(std::max<std::size_t>(sent_[view].gaussians.of(rank).count(), 1));
        places[i] =
            least + static_cast<std::size_t>((1 + reserve) * now / before * static_cast<double>(counts[i]));
    }
    return ranks::windows(places, gaussians.ranks());
}

}  // namespace gs::train
