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

std::optional<raster::view_strip> view_strips::of(std::size_t view, const camera& camera, int reach,
                                                  const ranks::communicator& ranks) const {
    if (ranks.count() == 1) return {};
    // The time for a pixel without splats is about that for 16 splats.
    constexpr std::uint64_t work_of_tile = 16 * raster::samples_per_tile;
    const auto in_tiles = [](int pixels) {
        return static_cast<std::size_t>((pixels + raster::tile_size - 1) / raster::tile_size);
    };
    std::vector<std::uint64_t> weights(in_tiles(camera.height), in_tiles(camera.width) * work_of_tile);
    if (view < work_.size() && work_[view].size() == weights.size())
        for (std::size_t row = 0; row < weights.size(); ++row) weights[row] += work_[view][row];
    raster::view_strip strip{{}, reach};
    for (int rank = 0; rank < ranks.count(); ++rank)
        strip.own_of_all.push_back(balanced_rows(weights, rank, ranks.count()));
    strip.own = strip.own_of_all[static_cast<std::size_t>(ranks.rank())];
    return strip;
}

std::optional<raster::view_strip> view_strips::of_step(std::size_t view, const camera& camera, int reach,
                                                       const ranks::communicator& ranks,
                                                       const std::optional<ranks::shares>& gaussians) const {
    auto strip = of(view, camera, reach, ranks);
    if (strip && gaussians) strip->windows = windows(view, *gaussians);
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
