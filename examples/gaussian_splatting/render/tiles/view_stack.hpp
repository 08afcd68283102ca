// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "../../core/error.hpp"
#include "../../scene/camera.hpp"
#include "../geometry/row_range.hpp"
#include "tile_lists.hpp"

namespace gs::raster {

/// The views that a renderer draws as one picture. They lie one below the other. Each of them begins at the
/// left border of a tile row, and has as many tile rows as the highest one. Pixels beside and below a smaller
/// view are not used. The picture of one view is this view.
class view_stack {
  public:
    view_stack() = default;
    view_stack(const camera& view) : view_stack(std::vector<camera>{view}) {}
    /// Throws `error` if only some views are panoramas, or if panoramas differ in width, because the columns
    /// of a panorama continue at its other border.
    explicit view_stack(std::vector<camera> views) : views_(std::move(views)) {
        for (const camera& view : views_) {
            width_ = std::max(width_, view.width);
            highest_ = std::max(highest_, view.height);
            if (view.is_panorama != views_[0].is_panorama ||
                (view.is_panorama && view.width != views_[0].width))
                throw error(
                    "one iteration cannot render panoramas of different widths, or panoramas and other "
                    "photos "
                    "(" +
                    std::to_string(views_[0].width) + " and " + std::to_string(view.width) +
                    " pixels wide): use --batch-size 1");
        }
    }

    std::size_t count() const { return views_.size(); }
    const camera& operator[](std::size_t i) const { return views_[i]; }
    bool is_panorama() const { return views_[0].is_panorama; }

    /// The size of the picture.
    /// @{
    int width() const { return width_; }
    int height() const { return count() == 1 ? highest_ : static_cast<int>(tiles_down()) * tile_size; }
    std::size_t pixels() const {
        return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
    unsigned tiles_across() const { return in_tiles(width_); }
    unsigned tiles_down() const { return static_cast<unsigned>(count()) * tiles_of_view(); }
    /// @}
    /// Returns the number of tile rows of each view.
    unsigned tiles_of_view() const { return in_tiles(highest_); }
    /// Returns the first row of pixels of a view.
    int first_row(std::size_t view) const { return static_cast<int>(view * tiles_of_view()) * tile_size; }
    /// Returns the rows of a view, counted from its first one, among some rows of the picture.
    row_range rows_of(std::size_t view, const row_range& rows) const {
        const auto of_view = [&](int row) {
            return std::clamp(row - first_row(view), 0, views_[view].height);
        };
        return {of_view(rows.first), of_view(rows.last)};
    }

  private:
    static unsigned in_tiles(int pixels) {
        return static_cast<unsigned>((pixels + tile_size - 1) / tile_size);
    }

    std::vector<camera> views_;
    int width_ = 0, highest_ = 0;
};

}  // namespace gs::raster
