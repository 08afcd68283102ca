// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "depth_points.hpp"

#include <algorithm>
#include <cmath>

#include "../../core/error.hpp"
#include "../../core/parallel.hpp"

namespace gs {
namespace {

constexpr double most_points = 100'000;
constexpr double millimeter = 1e-3;
constexpr double farthest = 5;  ///< meters; the reach of the sensor

/// A grid of values in a file, from 0 to 65535.
struct value_grid {
    int width = 0, height = 0;
    std::vector<std::uint16_t> values;

    explicit value_grid(const std::filesystem::path& file) { values = read_gray_png(file, width, height); }

    std::uint16_t at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

glm::u8vec3 color_at(const image& photo, double x_share, double y_share) {
    const auto column = static_cast<std::size_t>(x_share * photo.width);
    const auto row = static_cast<std::size_t>(y_share * photo.height);
    const std::uint8_t* pixel = &photo.rgba[4 * (row * static_cast<std::size_t>(photo.width) + column)];
    return {pixel[0], pixel[1], pixel[2]};
}

/// Clears the depths that the sensor marks as uncertain.
void keep_confident(value_grid& depths, const std::filesystem::path& file) {
    const value_grid confidence(file);
    if (confidence.width != depths.width || confidence.height != depths.height)
        throw error("the confidence map " + file.string() + " is not of the size of its depth map");
    for (std::size_t i = 0; i < depths.values.size(); ++i)
        if (confidence.values[i] < 65535) depths.values[i] = 0;
}

std::vector<colored_point> points_of(const image_record& taken, const std::filesystem::path& confidence,
                                     double most) {
    value_grid depths(taken.depth);
    if (std::filesystem::is_regular_file(confidence)) keep_confident(depths, confidence);
    const image photo = read_image(taken.file);
    const camera& c = taken.camera;
    const int step =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(depths.width * 1.0 * depths.height / most))));
    std::vector<colored_point> points;
    for (int y = step / 2; y < depths.height; y += step)
        for (int x = step / 2; x < depths.width; x += step) {
            const double depth = millimeter * depths.at(x, y);
            if (depth == 0 || depth > farthest) continue;
            const double x_share = (x + 0.5) / depths.width, y_share = (y + 0.5) / depths.height;
            const glm::dvec3 seen =
                depth * glm::dvec3((x_share * c.width - c.cx) / c.fx, (y_share * c.height - c.cy) / c.fy, 1);
            points.push_back(
                {glm::transpose(c.rotation) * (seen - c.translation), color_at(photo, x_share, y_share)});
        }
    return points;
}

}  // namespace

std::vector<colored_point> points_from_depths(const std::vector<image_record>& images,
                                              const std::filesystem::path& confidences) {
    std::vector<const image_record*> used;
    for (const image_record& one : images)
        if (!one.depth.empty() && !one.held_out) used.push_back(&one);
    std::vector<std::vector<colored_point>> parts(used.size());
    for_each_in_parallel(used.size(), [&](std::size_t i) {
        parts[i] = points_of(*used[i], confidences / used[i]->depth.filename(),
                             most_points / static_cast<double>(used.size()));
    });
    std::vector<colored_point> points;
    for (const auto& part : parts) points.insert(points.end(), part.begin(), part.end());
    return points;
}

}  // namespace gs
