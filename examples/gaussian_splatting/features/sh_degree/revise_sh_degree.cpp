// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "revise_sh_degree.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "../../core/parallel.hpp"
#include "../../engine/engine.hpp"
#include "../../image/image.hpp"
#include "../../scene/view_photo.hpp"
#include "direction.hpp"

namespace gs::features {
namespace {

float shown(float x) { return std::clamp(x, 0.0f, 1.0f); }

/// Replaces a photo by the residual: photo minus render, times four because bytes are coarse,
/// around mid-gray.
void leave_residual(image& photo, const std::vector<float>& render, const std::array<float, 3>& background) {
    const std::vector<float> expected = over_background(photo, background.data());
    const std::size_t n = render.size() / 3;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const float gray = 127.5f + 4 * 255 * (expected[c * n + i] - shown(render[c * n + i]));
            photo.rgba[4 * i + c] = static_cast<std::uint8_t>(std::lround(std::clamp(gray, 8.0f, 247.0f)));
        }
}

/// Observes the scene's points in the residuals of its training photos.
observed_points observe_residuals(const scene& of, train::engine& engine, const show_function& show,
                                  const std::array<float, 3>& background) {
    point_observer observer(of);
    std::vector<std::vector<float>> renders(static_cast<std::size_t>(omp_get_max_threads()));
    std::vector<camera> cameras(renders.size());  // with the poses that training has learned
    for (std::size_t first = 0; first < of.train.size(); first += renders.size()) {
        const std::size_t count = std::min(renders.size(), of.train.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            cameras[i] = engine.cameras().training_camera(first + i, of.train[first + i].camera);
            renders[i] = engine.render(cameras[i], background);
        }
        for_each_in_parallel(count, [&](std::size_t i) {
            show(first + i, of.train[first + i].camera.width, renders[i]);
            image residual = view_photo(of.train[first + i]).pixels();
            leave_residual(residual, renders[i], background);
            observer.observe(first + i, residual, cameras[i]);
        });
    }
    return observer.observations();
}

/// Returns the root mean square by which the renders of up to eight training views change if colors
/// use only SH coefficients up to this degree.
double change_above(int degree, train::engine& engine, const scene& of,
                    const std::array<float, 3>& background) {
    const std::size_t views = std::min<std::size_t>(of.train.size(), 8);
    double sum = 0, values = 0;
    for (std::size_t i = 0; i < views; ++i) {
        const camera& camera = of.train[i * of.train.size() / views].camera;
        const auto all = engine.render(camera, background),
                   some = engine.render(camera, background, {.sh_degree = degree});
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
