// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "revise_sh_degree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "../../core/parallel.hpp"
#include "../../engine/engine.hpp"
#include "../../image/image.hpp"
#include "../../scene/view_photo.hpp"
#include "direction.hpp"

namespace gs::features {
namespace {

float shown(float x) { return std::clamp(x, 0.0f, 1.0f); }

/// Returns the places of the pixels around some points, in the order of `point_observer::observe_patches`.
std::vector<std::uint32_t> pixels_around(std::span<const place_in_photo> points, int width) {
    std::vector<std::uint32_t> pixels;
    pixels.reserve(9 * points.size());
    for (const place_in_photo& p : points)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                pixels.push_back(static_cast<std::uint32_t>((static_cast<int>(p.y) + dy) * width +
                                                            static_cast<int>(p.x) + dx));
    return pixels;
}

/// Returns the residuals of these pixels: photo minus render, times four because bytes are coarse, around
/// mid-gray. They have the photo's alpha.
image residuals(const image& photo, std::span<const std::uint32_t> pixels, const std::vector<float>& render) {
    const std::size_t n = pixels.size();
    image left{3, static_cast<int>(n / 3), std::vector<std::uint8_t>(4 * n)};
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint8_t* const rgba = &photo.rgba[4 * std::size_t{pixels[i]}];
        for (std::size_t c = 0; c < 3; ++c) {
            const float expected = static_cast<float>(rgba[c]) / 255;
            const float gray = 127.5f + 4 * 255 * (expected - shown(render[c * n + i]));
            left.rgba[4 * i + c] = static_cast<std::uint8_t>(std::lround(std::clamp(gray, 8.0f, 247.0f)));
        }
        left.rgba[4 * i + 3] = rgba[3];
    }
    return left;
}

/// Observes the scene's points in the residuals of its training photos.
observed_points observe_residuals(const scene& of, train::engine& engine, const show_function& show,
                                  const std::array<float, 3>& background) {
    constexpr std::size_t at_once = 64;  // limits the memory for pixels
    point_observer observer(of);
    struct observed_view {
        std::size_t index;
        camera taken_with;  ///< with the pose that training has learned
        std::vector<place_in_photo> points;
        std::vector<std::uint32_t> pixels;
        std::vector<float> render;
    };
    for (std::size_t first = 0; first < of.train.size(); first += at_once) {
        std::vector<observed_view> views;
        for (std::size_t v = first; v < std::min(first + at_once, of.train.size()); ++v)
            views.push_back({v, engine.cameras().training_camera(v, of.train[v].camera), {}, {}, {}});
        for_each_in_parallel(views.size(), [&](std::size_t i) {
            views[i].points = observer.in_sight(views[i].taken_with);
            views[i].pixels = pixels_around(views[i].points, views[i].taken_with.width);
        });
        std::erase_if(views, [](const observed_view& v) { return v.points.empty(); });
        for (observed_view& v : views)
            v.render = engine.render(v.taken_with, background, {.pixels = v.pixels});
        for_each_in_parallel(views.size(), [&](std::size_t i) {
            observed_view& v = views[i];
            show(v.index, {v.taken_with.width, v.taken_with.height, v.pixels}, v.render);
            const view_photo photo(of.train[v.index]);
            observer.observe_patches(v.index, v.points, residuals(photo.pixels(), v.pixels, v.render),
                                     v.taken_with);
        });
    }
    return observer.observations();
}

/// Returns the places of at most 50,000 pixels of a view, at equal distances and in all columns.
std::vector<std::uint32_t> spread_pixels(const camera& c) {
    constexpr std::size_t most = 50'000;
    const auto width = static_cast<std::size_t>(c.width);
    const std::size_t all = width * static_cast<std::size_t>(c.height);
    std::size_t step = (all + most - 1) / most;
    while (std::gcd(step, width) > 1) ++step;
    std::vector<std::uint32_t> places;
    for (std::size_t i = 0; i < all; i += step) places.push_back(static_cast<std::uint32_t>(i));
    return places;
}

/// Returns the root mean square by which the renders of up to eight training views change if colors
/// use only SH coefficients up to this degree. Looks at some pixels of large views.
double change_above(int degree, train::engine& engine, const scene& of,
                    const std::array<float, 3>& background) {
    const std::size_t views = std::min<std::size_t>(of.train.size(), 8);
    double sum = 0, values = 0;
    for (std::size_t i = 0; i < views; ++i) {
        const camera& camera = of.train[i * of.train.size() / views].camera;
        const std::vector<std::uint32_t> pixels = spread_pixels(camera);
        const auto all = engine.render(camera, background, {.pixels = pixels}),
                   some = engine.render(camera, background, {.sh_degree = degree, .pixels = pixels});
        for (std::size_t k = 0; k < all.size(); ++k) {
            const double d = static_cast<double>(shown(all[k]) - shown(some[k]));
            sum += d * d;
        }
        values += static_cast<double>(all.size());
    }
    return std::sqrt(sum / values);
}

}  // namespace

sh_review revise_sh_degree(train::engine& engine, const scene& scene, const show_function& show,
                           const std::array<float, 3>& background, int sh_degree) {
    sh_review review;
    engine.ranks().prepare_renders();
    direction_statistics left;
    if (!scene.points.empty())
        left = measure_direction(scene_statistics(scene, observe_residuals(scene, engine, show, background)));
    review.unexplained = left.unexplained;
    // Adds no degree if there are too few points for a decision.
    const int recommended = left.is_known() ? left.degree() : 0;
    review.sh_degree = std::max(sh_degree, recommended);
    if (sh_degree > 0) review.change = change_above(sh_degree - 1, engine, scene, background);
    if (recommended > 0) return review;
    while (review.change && *review.change < band_change_limit) {
        --review.sh_degree;
        review.change.reset();
        if (review.sh_degree > 0)
            review.change = change_above(review.sh_degree - 1, engine, scene, background);
    }
    return review;
}

}  // namespace gs::features
