// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "motion_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "../../core/median.hpp"
#include "../../core/parallel.hpp"
#include "../../core/solve.hpp"
#include "../../scene/view_photo.hpp"

namespace gs::features {
namespace {

constexpr double least_contrast = 0.12;       ///< of an edge
constexpr int reach = 16;                     ///< of an edge to each side, in pixels
constexpr double flank = 0.15;                ///< share of the largest slope at which an edge ends
constexpr double sharpest = 0.2;              ///< quantile of the widths
constexpr double sharp_photos = 0.3;          ///< quantile of the photos that are taken for sharp
constexpr double width_per_length = 0.85;     ///< of an edge that a motion of several pixels widens
constexpr std::size_t most_pixels = 400'000;  ///< of a photo that are examined

/// The brightness of a photo, in [0, 1].
class brightness {
  public:
    explicit brightness(const image& photo)
        : width_(photo.width), height_(photo.height), values_(photo.rgba.size() / 4) {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const std::uint8_t* rgba = &photo.rgba[4 * i];
            values_[i] =
                photo.is_masked(i) ? std::nanf("") : static_cast<float>(rgba[0] + rgba[1] + rgba[2]) / 765;
        }
    }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Precondition: the pixel is in the photo.
    double at(int x, int y) const {
        return static_cast<double>(values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                           static_cast<std::size_t>(x)]);
    }
    /// Interpolates between pixels. NaN outside of the photo.
    double between(const glm::dvec2& p) const {
        const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
        if (x < 0 || y < 0 || x + 1 >= width_ || y + 1 >= height_) return std::nan("");
        const double u = p.x - x, v = p.y - y;
        return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) +
               v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
    }
    /// Sobel's filter. Precondition: the pixel is not at the border.
    glm::dvec2 gradient(int x, int y) const {
        const auto slope = [&](double a, double b, double c, double d, double e, double f) {
            return (d - a + 2 * (e - b) + f - c) / 8;
        };
        return {slope(at(x - 1, y - 1), at(x - 1, y), at(x - 1, y + 1), at(x + 1, y - 1), at(x + 1, y),
                      at(x + 1, y + 1)),
                slope(at(x - 1, y - 1), at(x, y - 1), at(x + 1, y - 1), at(x - 1, y + 1), at(x, y + 1),
                      at(x + 1, y + 1))};
    }

  private:
    int width_, height_;
    std::vector<float> values_;
};

/// Returns the slope half a pixel beyond a place.
double slope_at(const brightness& light, const glm::dvec2& place, const glm::dvec2& across) {
    return light.between(place + 0.5 * across) - light.between(place - 0.5 * across);
}

/// Returns the width of the edge at a pixel: its contrast over its slope. Returns 0 if there is none, or
/// if it is steeper beside the pixel.
double width_of_edge(const brightness& light, const glm::dvec2& place, const glm::dvec2& across) {
    const double slope = slope_at(light, place, across);
    if (!(slope > slope_at(light, place - across, across) &&
          slope >= slope_at(light, place + across, across)))
        return 0;
    double contrast = slope;
    for (const double side : {-1.0, 1.0}) {
        int i = 1;
        for (; i <= reach; ++i) {
            const double next = slope_at(light, place + side * i * across, across);
            if (std::isnan(next)) return 0;
            if (next < flank * slope) break;
            contrast += next;
        }
        if (i > reach) return 0;  // not an edge, but a gradual change
    }
    return contrast >= least_contrast ? contrast / slope : 0;
}

/// A fit of c0 + c1 cos(2 a) + c2 sin(2 a) to values at angles a, by weighted least squares.
struct harmonic_fit {
    std::array<double, 3> coefficients{}, errors{};
};
harmonic_fit fit_harmonics(const std::vector<std::array<double, 3>>& angle_value_error) {
    std::array<std::array<double, 3>, 3> normal{};
    std::array<double, 3> right{};
    const auto row_of = [](double angle) {
        return std::array<double, 3>{1, std::cos(2 * angle), std::sin(2 * angle)};
    };
    for (const auto& [angle, value, error] : angle_value_error) {
        const auto row = row_of(angle);
        for (std::size_t i = 0; i < 3; ++i) {
            right[i] += row[i] * value / (error * error);
            for (std::size_t j = 0; j < 3; ++j) normal[i][j] += row[i] * row[j] / (error * error);
        }
    }
    harmonic_fit fit;
    fit.coefficients = solve(normal, right);
    double square = 0;
    for (const auto& [angle, value, error] : angle_value_error) {
        const auto row = row_of(angle);
        double off = value;
        for (std::size_t i = 0; i < 3; ++i) off -= row[i] * fit.coefficients[i];
        square += off * off / (error * error);
    }
    // Errors that the residuals show, too.
    const double excess =
        std::max(1.0, square / std::max(1.0, static_cast<double>(angle_value_error.size()) - 3));
    for (std::size_t i = 0; i < 3; ++i) {
        std::array<double, 3> unit{};
        unit[i] = 1;
        fit.errors[i] = std::sqrt(excess * std::max(0.0, solve(normal, unit)[i]));
    }
    return fit;
}

double angle_of(std::size_t k) {
    return std::numbers::pi * static_cast<double>(k) / static_cast<double>(edge_widths::directions);
}

bool counts(const edge_widths& photo, std::size_t k) {
    return photo.count[k] >= motion_evidence::least_edges;
}

photo_blur blur_of(const edge_widths& photo, const std::array<double, edge_widths::directions>& usual) {
    std::vector<std::array<double, 3>> values;
    for (std::size_t k = 0; k < edge_widths::directions; ++k) {
        if (!counts(photo, k) || usual[k] == 0) continue;
        const double w = photo.width[k];
        values.push_back({angle_of(k), w * w - usual[k] * usual[k], 2 * w * photo.error[k] + 0.05});
    }
    photo_blur blur;
    if (values.size() < motion_evidence::least_directions) return blur;
    const harmonic_fit fit = fit_harmonics(values);
    const double c = fit.coefficients[1], s = fit.coefficients[2], amplitude = std::hypot(c, s);
    blur.is_judged = true;
    constexpr double scale = 2 / (width_per_length * width_per_length);
    blur.square = scale * amplitude;
    blur.error = scale * std::hypot(fit.errors[1], fit.errors[2]);
    const double angle = 0.5 * std::atan2(s, c);
    blur.motion = std::sqrt(blur.square) * glm::dvec2(std::cos(angle), std::sin(angle));
    return blur;
}

}  // namespace

glm::dvec2 edge_widths::direction(std::size_t k) { return {std::cos(angle_of(k)), std::sin(angle_of(k))}; }

edge_widths measure_edges(const image& photo) {
    const brightness light(photo);
    std::array<std::vector<double>, edge_widths::directions> widths;
    const int step = static_cast<int>(photo.rgba.size() / 4 / most_pixels) + 1;
    for (int y = 1; y + 1 < light.height(); y += step)
        for (int x = 1; x + 1 < light.width(); ++x) {
            const glm::dvec2 g = light.gradient(x, y);
            const double length = std::hypot(g.x, g.y);
            if (!(length > least_contrast / reach)) continue;
            const double width = width_of_edge(light, glm::dvec2(x, y), g / length);
            if (width == 0) continue;
            const double turn = std::atan2(g.y, g.x) / std::numbers::pi;  // from -1 to 1
            const long k = std::lround((turn + 1) * static_cast<double>(edge_widths::directions));
            widths[static_cast<std::size_t>(k) % edge_widths::directions].push_back(width);
        }
    edge_widths found;
    for (std::size_t k = 0; k < edge_widths::directions; ++k) {
        std::vector<double>& all = widths[k];
        found.count[k] = all.size();
        if (all.size() < motion_evidence::least_edges) continue;
        const double n = static_cast<double>(all.size());
        const double spread = std::sqrt(sharpest * (1 - sharpest) / n);
        found.width[k] = quantile(all, sharpest);
        found.error[k] = (quantile(all, std::min(1.0, sharpest + spread)) -
                          quantile(all, std::max(0.0, sharpest - spread))) /
                         2;
    }
    return found;
}

bool photo_blur::is_clear() const {
    return is_judged && square > motion_evidence::least_blur * motion_evidence::least_blur &&
           square > motion_evidence::least_errors * error;
}

std::size_t motion_evidence::judged() const {
    return static_cast<std::size_t>(std::ranges::count(photos, true, &photo_blur::is_judged));
}
std::size_t motion_evidence::blurred() const {
    return static_cast<std::size_t>(std::ranges::count_if(photos, &photo_blur::is_clear));
}
bool motion_evidence::is_clear() const {
    return blurred() >= least_blurred && double(blurred()) >= least_share * double(judged());
}

motion_evidence find_motion_blur(const scene_statistics& statistics) {
    const scene& scene = statistics.scene();
    std::vector<edge_widths> edges(scene.train.size());
    for_each_in_parallel(
        edges.size(), [&](std::size_t v) { edges[v] = measure_edges(view_photo(scene.train[v]).pixels()); });
    std::array<double, edge_widths::directions> usual{};
    for (std::size_t k = 0; k < usual.size(); ++k) {
        std::vector<double> widths;
        for (const edge_widths& photo : edges)
            if (counts(photo, k)) widths.push_back(photo.width[k]);
        if (widths.size() >= motion_evidence::least_photos) usual[k] = quantile(widths, sharp_photos);
    }
    motion_evidence found;
    for (const edge_widths& photo : edges) found.photos.push_back(blur_of(photo, usual));
    return found;
}

}  // namespace gs::features
