// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sky_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "../../core/parallel.hpp"
#include "../../scene/image_radius.hpp"
#include "../../scene/lens_falloff.hpp"
#include "../../scene/view_photo.hpp"

namespace gs::features {
namespace {

constexpr int cells_along = 32;
constexpr double smooth = 0.04;  ///< largest standard deviation within a cell, without noise

/// Returns the color and the content of a square. Smoothness is measured on the averages of rows and
/// columns, in which noise alone is small.
photo_cell look_at_cell(const image& photo, int left, int top, int side) {
    std::vector<glm::dvec3> columns(static_cast<std::size_t>(side)), rows(static_cast<std::size_t>(side));
    glm::dvec3 mean(0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const std::uint8_t* rgba =
                &photo.rgba[4 * (static_cast<std::size_t>(top + y) * static_cast<std::size_t>(photo.width) +
                                 static_cast<std::size_t>(left + x))];
            if (rgba[3] != 255) return {};
            const glm::dvec3 color = glm::dvec3(rgba[0], rgba[1], rgba[2]) / (255.0 * side);
            columns[static_cast<std::size_t>(x)] += color;
            rows[static_cast<std::size_t>(y)] += color;
            mean += color / double(side);
        }
    double square = 0;
    for (const auto* lines : {&columns, &rows})
        for (const glm::dvec3& line : *lines) square += glm::dot(line - mean, line - mean) / (3.0 * side);
    return {glm::vec3(mean),
            square > smooth * smooth ? photo_cell::content::rough : photo_cell::content::smooth};
}

photo_cells cells_of(const camera& c, const image& photo, const std::vector<colored_point>& points) {
    photo_cells found;
    found.side = std::max(4, std::max(c.width, c.height) / cells_along);
    found.across = c.width / found.side;
    found.down = c.height / found.side;
    for (int row = 0; row < found.down; ++row)
        for (int column = 0; column < found.across; ++column)
            found.cells.push_back(look_at_cell(photo, column * found.side, row * found.side, found.side));
    for (const colored_point& point : points) {
        const auto p = c.see(point.position);
        if (!p) continue;
        const double x = p->x / found.side, y = p->y / found.side;
        if (!(x > -1 && y > -1 && x < found.across + 1 && y < found.down + 1)) continue;
        for (int row = std::max(0, static_cast<int>(std::floor(y)) - 1);
             row <= std::min(found.down - 1, static_cast<int>(std::floor(y)) + 1); ++row)
            for (int column = std::max(0, static_cast<int>(std::floor(x)) - 1);
                 column <= std::min(found.across - 1, static_cast<int>(std::floor(x)) + 1); ++column)
                found.cells[static_cast<std::size_t>(row * found.across + column)].near_points = true;
    }
    return found;
}

}  // namespace

glm::dvec2 photo_cells::middle(std::size_t cell) const {
    const int column = static_cast<int>(cell) % across, row = static_cast<int>(cell) / across;
    return {(column + 0.5) * side, (row + 0.5) * side};
}

glm::dvec3 photo_cells::ray(const camera& taken_with, std::size_t cell) const {
    const glm::dvec2 place = middle(cell);
    return taken_with.ray(place.x, place.y);
}

void remove_falloff(const scene& of, const std::array<double, 3>& strengths,
                    std::vector<photo_cells>& photos) {
    lens_falloff falloff;
    falloff.channels = strengths;
    for (std::size_t v = 0; v < photos.size(); ++v) {
        const camera& c = of.train[v].camera;
        if (c.is_panorama) continue;
        for (std::size_t i = 0; i < photos[v].cells.size(); ++i) {
            const glm::dvec2 middle = photos[v].middle(i);
            const auto factors = falloff.at(square_radius(c, middle.x, middle.y));
            for (int k = 0; k < 3; ++k)
                photos[v].cells[i].color[k] /= static_cast<float>(factors[static_cast<std::size_t>(k)]);
        }
    }
}

std::vector<photo_cells> divide_photos(const scene& of) {
    std::vector<photo_cells> photos(of.train.size());
    for_each_in_parallel(photos.size(), [&](std::size_t v) {
        photos[v] = cells_of(of.train[v].camera, view_photo(of.train[v]).pixels(), of.points);
    });
    return photos;
}

}  // namespace gs::features
