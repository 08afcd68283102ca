// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "direction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../../core/median.hpp"
#include "../../core/parallel.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../moving/moving_evidence.hpp"
#include "../text.hpp"

namespace gs::features {
namespace {

constexpr double ridges[] = {0.3, 1, 3, 10};  ///< penalties in observations; none on degree 0
constexpr float one_size = 1.6f;              ///< of footprints: see `keep_one_size`
constexpr double outlier = 4.0;               ///< standard deviations; another object hid the point

constexpr std::size_t some_points = 10;

/// Returns the squared residuals of the observations of one point, for SH degrees 0 to 3. A
/// residual is the difference between an observation and its leave-one-out prediction. Each square
/// is the mean over color channels.
std::vector<std::array<double, 4>> residuals_of(const std::vector<observation>& seen, double ridge) {
    const std::size_t n = seen.size();
    glm::dvec3 mean(0);
    for (const observation& o : seen) mean += glm::dvec3(o.color) / double(n);
    std::vector<std::array<double, 16>> rows(n);
    std::array<double, 16> center{};
    for (std::size_t i = 0; i < n; ++i) {
        sh_basis<double>(3, glm::dvec3(seen[i].direction), rows[i].data());
        for (std::size_t k = 0; k < 16; ++k) center[k] += rows[i][k] / double(n);
    }
    // Subtracts the means, so that the ridge penalty does not affect the constant.
    for (auto& row : rows)
        for (std::size_t k = 0; k < 16; ++k) row[k] -= center[k];
    std::vector<std::array<double, 4>> left(n);
    for (int degree = 0; degree <= 3; ++degree) {
        const auto size = static_cast<std::size_t>((degree + 1) * (degree + 1) - 1);
        // The Cholesky factor of the normal equations, for degrees 1 to `degree`.
        double factor[15][15] = {};
        for (std::size_t a = 0; a < size; ++a)
            for (std::size_t b = 0; b <= a; ++b) {
                double sum = a == b ? ridge : 0;
                for (const auto& row : rows) sum += row[a + 1] * row[b + 1];
                for (std::size_t k = 0; k < b; ++k) sum -= factor[a][k] * factor[b][k];
                factor[a][b] = a == b ? std::sqrt(sum) : sum / factor[b][b];
            }
        // Multiplies each row by the inverse factor. With these rows W, the hat matrix is W W^T
        // plus 1/n for the constant.
        std::vector<std::array<double, 15>> whitened(n);
        std::array<glm::dvec3, 15> projected{};
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t a = 0; a < size; ++a) {
                double sum = rows[i][a + 1];
                for (std::size_t k = 0; k < a; ++k) sum -= factor[a][k] * whitened[i][k];
                whitened[i][a] = sum / factor[a][a];
                projected[a] += whitened[i][a] * (glm::dvec3(seen[i].color) - mean);
            }
        for (std::size_t i = 0; i < n; ++i) {
            double own = 1 / double(n);  // weight of an observation in its own prediction
            glm::dvec3 rest = glm::dvec3(seen[i].color) - mean;
            for (std::size_t a = 0; a < size; ++a) {
                own += whitened[i][a] * whitened[i][a];
                rest -= whitened[i][a] * projected[a];
            }
            rest /= 1 - own;
            left[i][static_cast<std::size_t>(degree)] = glm::dot(rest, rest) / 3;
        }
    }
    return left;
}

/// The squared residuals of the observations of each point. Those of outliers are clipped.
using point_residuals = std::vector<std::vector<std::array<double, 4>>>;

point_residuals residuals_with(const observed_points& points, double ridge) {
    point_residuals residuals(points.size());
    for_each_in_parallel(points.size(), [&](std::size_t p) {
        if (points[p].size() >= scene_statistics::least_photos_of_point)
            residuals[p] = residuals_of(points[p], ridge);
    });
    std::vector<double> sizes;
    for (const auto& of_point : residuals)
        for (const auto& r : of_point) sizes.push_back(r[0]);
    const double limit = outlier * outlier * 1.4826 * 1.4826 * median(sizes);
    for (auto& of_point : residuals)
        for (auto& r : of_point)
            for (double& x : r) x = std::min(x, limit);
    return residuals;
}

std::array<double, 4> mean_of(const point_residuals& residuals) {
    std::size_t count = 0;
    for (const auto& of_point : residuals) count += of_point.size();
    std::array<double, 4> mean{};
    for (const auto& of_point : residuals)
        for (const auto& r : of_point)
            for (std::size_t d = 0; d < 4; ++d) mean[d] += r[d] / double(count);
    return mean;
}

}  // namespace

bool direction_statistics::is_known() const { return points >= enough_points; }

int direction_statistics::degree() const {
    if (!is_known()) return has_points && points < some_points ? 0 : 3;
    std::size_t degree = 0;
    for (std::size_t d = 1; d < unexplained.size(); ++d) {
        const double gone = unexplained[degree] - unexplained[d];
        if (gone >= least_share * unexplained[0] && gone >= least_amplitude * least_amplitude) degree = d;
    }
    return static_cast<int>(degree);
}

std::array<double, 4> unexplained_by_direction(const observed_points& points) {
    std::array<double, 4> least;
    least.fill(std::numeric_limits<double>::infinity());
    for (const double ridge : ridges) {
        const std::array<double, 4> by_ridge = mean_of(residuals_with(points, ridge));
        for (std::size_t d = 0; d < 4; ++d) least[d] = std::min(least[d], by_ridge[d]);
    }
    return least;
}

std::vector<double> explained_by_direction(const observed_points& points, int degree) {
    const auto d = static_cast<std::size_t>(degree);
    point_residuals best;
    double least = std::numeric_limits<double>::infinity();
    for (const double ridge : ridges) {
        point_residuals by_ridge = residuals_with(points, ridge);
        const double unexplained = mean_of(by_ridge)[d];
        if (!(unexplained < least)) continue;
        least = unexplained;
        best = std::move(by_ridge);
    }
    std::vector<double> explained(points.size(), 0.0);
    for (std::size_t p = 0; p < best.size(); ++p)
        for (const auto& r : best[p]) explained[p] += (r[0] - r[d]) / double(best[p].size());
    return explained;
}

observed_points comparable_points(const scene_statistics& statistics) {
    observed_points points = statistics.smooth_points();
    if (points.empty()) return points;
    const std::vector<bool> left_out = find_moving_things(statistics).contributing_photos();
    for (auto& seen : points) std::erase_if(seen, [&](const observation& o) { return left_out[o.view]; });
    statistics.remove_clear_falloff(points);
    const photo_brightness& brightness = statistics.brightness_of_smooth();
    for (auto& seen : points) {
        std::erase_if(seen, [&](const observation& o) { return brightness.error[o.view] == 0; });
        keep_one_size(seen, one_size);
        for (observation& o : seen) o.color *= static_cast<float>(std::exp2(-brightness.log2[o.view]));
    }
    std::erase_if(points,
                  [](const auto& seen) { return seen.size() < scene_statistics::least_photos_of_point; });
    return points;
}

direction_statistics measure_direction(const scene_statistics& statistics) {
    direction_statistics found;
    found.has_points = !statistics.scene().points.empty();
    const observed_points points = comparable_points(statistics);
    found.points = points.size();
    if (!points.empty()) found.unexplained = unexplained_by_direction(points);
    return found;
}

}  // namespace gs::features
