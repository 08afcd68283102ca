// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "smooth_colors.hpp"

#include <algorithm>
#include <cstdint>

namespace gs {
namespace {

bool shows_color(const std::uint8_t* rgba) {
    constexpr int least = 6, most = 249;  // of a channel that is not saturated
    return rgba[3] == 255 && std::all_of(rgba, rgba + 3, [](int v) { return v >= least && v <= most; });
}

}  // namespace

smooth_colors::smooth_colors(const image& photo)
    : width_(photo.width), height_(photo.height), colors_(photo.rgba.size() / 4), is_known_(colors_.size()) {
    for (int y = 1; y + 1 < height_; ++y)
        for (int x = 1; x + 1 < width_; ++x) {
            glm::ivec3 sum(0);
            bool all = true;
            for (int row = y - 1; row <= y + 1; ++row)
                for (int column = x - 1; column <= x + 1; ++column) {
                    const std::uint8_t* rgba = &photo.rgba[4 * index(column, row)];
                    sum += glm::ivec3(rgba[0], rgba[1], rgba[2]);
                    all = all && shows_color(rgba);
                }
            colors_[index(x, y)] = glm::vec3(sum) / (9 * 255.0f);
            is_known_[index(x, y)] = all;
        }
}

std::optional<smooth_colors::sample> smooth_colors::at(double x, double y) const {
    x -= 0.5;
    y -= 0.5;
    if (!(x >= 0 && y >= 0 && x < width_ - 1 && y < height_ - 1)) return std::nullopt;
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const std::size_t upper = index(left, top), lower = index(left, top + 1);
    if (!is_known_[upper] || !is_known_[upper + 1] || !is_known_[lower] || !is_known_[lower + 1])
        return std::nullopt;
    const double right = x - left, down = y - top;
    const glm::dvec3 a(colors_[upper]), b(colors_[upper + 1]), c(colors_[lower]), d(colors_[lower + 1]);
    const glm::dvec3 above = a + right * (b - a), below = c + right * (d - c);
    return sample{above + down * (below - above), (1 - down) * (b - a) + down * (d - c), below - above};
}

}  // namespace gs
