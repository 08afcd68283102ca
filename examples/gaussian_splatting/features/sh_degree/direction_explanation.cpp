// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "direction_explanation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>

#include "../../core/parallel.hpp"
#include "../../scene/view_photo.hpp"
#include "../text.hpp"
#include "direction.hpp"

namespace gs::features {
namespace {

constexpr std::size_t marked_points = 60, listed_points = 6, patches_of_point = 8;
constexpr double spacing_of_listed = 0.05;                   ///< relative to the scene's extent
constexpr int patch_side = 64, swatch_height = 12, gap = 4;  ///< in pixels of the sheet
constexpr int row_height = patch_side + 2 * swatch_height + gap;
constexpr float contrast = 4;  ///< of the second swatch

/// The same point in several photos.
using point_views = std::vector<observation>;

/// The points that depend most on the direction.
struct strong_points {
    observed_points listed;  ///< a few of them that are far apart, the strongest first
    observed_points others;
};

strong_points strongest(const observed_points& points, int degree, const scene& of) {
    const std::vector<double> explained = explained_by_direction(points, degree);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t p) { return explained[p]; });
    const double spacing = spacing_of_listed * of.extent();
    const auto position = [&](const point_views& seen) { return of.points[seen.front().point].position; };
    strong_points found;
    for (std::size_t i = 0; i < std::min(order.size(), marked_points); ++i) {
        const point_views& seen = points[order[i]];
        const bool is_apart = std::ranges::none_of(found.listed, [&](const point_views& other) {
            return glm::distance(position(seen), position(other)) < spacing;
        });
        (is_apart && found.listed.size() < listed_points ? found.listed : found.others).push_back(seen);
    }
    return found;
}

/// Returns a few observations of a point: first the brightest one, and then the others by the angle
/// between their viewing directions and that of the brightest.
point_views by_angle_from_brightest(point_views seen) {
    const auto brightness = [](const observation& o) { return o.color.r + o.color.g + o.color.b; };
    const glm::vec3 from = std::ranges::max(seen, {}, brightness).direction;
    std::ranges::stable_sort(seen, std::greater(),
                             [&](const observation& o) { return glm::dot(o.direction, from); });
    if (seen.size() <= patches_of_point) return seen;
    point_views some;
    for (std::size_t i = 0; i < patches_of_point; ++i)
        some.push_back(seen[i * (seen.size() - 1) / (patches_of_point - 1)]);
    return some;
}

/// An image with a row per point, of patches of photos around it. Below each patch is a swatch of
/// the point's color, and one in which the differences within the row are larger.
class contact_sheet {
  public:
    contact_sheet(const scene& of, const photo_brightness& brightness, std::vector<point_views> rows)
        : scene_(of), brightness_(brightness), rows_(std::move(rows)) {
        pixels_.width = static_cast<int>(patches_of_point) * (patch_side + gap) - gap;
        pixels_.height = static_cast<int>(rows_.size()) * row_height - gap;
        pixels_.rgba.assign(
            4 * static_cast<std::size_t>(pixels_.width) * static_cast<std::size_t>(pixels_.height), 255);
    }

    image draw() && {
        std::map<std::uint32_t, std::vector<std::pair<std::size_t, std::size_t>>> by_view;
        for (std::size_t row = 0; row < rows_.size(); ++row)
            for (std::size_t i = 0; i < rows_[row].size(); ++i)
                by_view[rows_[row][i].view].emplace_back(row, i);
        const std::vector views(by_view.begin(), by_view.end());
        for_each_in_parallel(views.size(), [&](std::size_t v) {
            const view_photo photo(scene_.train[views[v].first]);
            for (const auto& [row, column] : views[v].second) draw_patch(photo.pixels(), row, column);
        });
        return std::move(pixels_);
    }

  private:
    /// Sets a pixel of the sheet to a color in [0, 1].
    void set(int x, int y, const glm::vec3& color) {
        const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels_.width) +
                       static_cast<std::size_t>(x);
        for (int c = 0; c < 3; ++c) pixels_.rgba[4 * i + static_cast<std::size_t>(c)] = to_byte(color[c]);
    }

    void draw_patch(const image& photo, std::size_t row, std::size_t column) {
        const observation& seen = rows_[row][column];
        const glm::dvec2& place = seen.place;
        const double half = std::max(4.0, std::max(photo.width, photo.height) / 60.0);
        const auto exposed = static_cast<float>(std::exp2(-brightness_.log2[seen.view]));
        const int left = static_cast<int>(column) * (patch_side + gap),
                  top = static_cast<int>(row) * row_height;
        for (int y = 0; y < patch_side; ++y)
            for (int x = 0; x < patch_side; ++x) {
                const auto pixel = [&](double middle, int at, int most) {
                    const double from = middle + half * ((2 * at + 1.0) / patch_side - 1);
                    return static_cast<std::size_t>(std::clamp(static_cast<int>(from), 0, most - 1));
                };
                const std::uint8_t* rgba =
                    &photo.rgba[4 * (pixel(place.y, y, photo.height) * static_cast<std::size_t>(photo.width) +
                                     pixel(place.x, x, photo.width))];
                set(left + x, top + y, exposed / 255 * glm::vec3(rgba[0], rgba[1], rgba[2]));
            }
        glm::vec3 mean(0);
        for (const observation& o : rows_[row]) mean += o.color / static_cast<float>(rows_[row].size());
        for (int y = 0; y < swatch_height; ++y)
            for (int x = 0; x < patch_side; ++x) {
                set(left + x, top + patch_side + y, seen.color);
                set(left + x, top + patch_side + swatch_height + y, mean + contrast * (seen.color - mean));
            }
    }

    const scene& scene_;
    const photo_brightness& brightness_;
    std::vector<point_views> rows_;
    image pixels_;
};

/// Returns the photo that shows most of the points, with rings around them.
pages::marked_photo photo_with_most(const strong_points& points, const scene& of) {
    std::vector<std::vector<pages::mark>> marks(of.train.size());
    for (const auto* some : {&points.others, &points.listed})
        for (const point_views& seen : *some)
            for (const observation& o : seen)
                marks[o.view].push_back(ring_around(o, some == &points.listed ? 1 : 0));
    const auto most = std::ranges::max_element(marks, {}, [](const auto& rings) { return rings.size(); });
    const view& shown = of.train[static_cast<std::size_t>(most - marks.begin())];
    return shown_photo(shown, "Where color varies most with the direction",
                       "Rings: the points with the strongest dependence. The sheet shows those in magenta.",
                       std::move(*most));
}

pages::line_chart degree_chart(const direction_statistics& found) {
    pages::curve unexplained{"all points", {}};
    for (std::size_t d = 0; d < found.unexplained.size(); ++d)
        unexplained.points.emplace_back(static_cast<double>(d), 100 * std::sqrt(found.unexplained[d]));
    return {"Unexplained difference between photos (%)", "SH degree", {std::move(unexplained)}, true};
}

}  // namespace

explanation explain_direction(const scene_statistics& statistics, int degree) {
    explanation made{
        .condition =
            text("a further SH degree removes at least %.0f %% of the mean square that degree 0 leaves "
                 "unexplained, and a root mean square of at least %.1f %%",
                 100 * direction_statistics::least_share, 100 * direction_statistics::least_amplitude)};
    const observed_points points = comparable_points(statistics);
    if (points.empty()) return made;
    made.charts.push_back(degree_chart(measure_direction(statistics)));
    const strong_points found = strongest(points, degree, statistics.scene());
    made.photos.push_back(photo_with_most(found, statistics.scene()));
    std::vector<point_views> rows;
    for (const point_views& seen : found.listed) rows.push_back(by_angle_from_brightest(seen));
    image sheet =
        contact_sheet(statistics.scene(), statistics.brightness_of_smooth(), std::move(rows)).draw();
    const int width = sheet.width, height = sheet.height;
    made.photos.push_back(
        {.label = "The same point in several photos",
         .note =
             "Each row is one point. Its brightest photo comes first, and the angle from there grows to the "
             "right. A color that depends on the direction changes gradually; noise does not. " +
             text("Below: the color, and with %.0f times the contrast.", static_cast<double>(contrast)),
         .pixels = std::move(sheet),
         .width = width,
         .height = height});
    return made;
}

}  // namespace gs::features
