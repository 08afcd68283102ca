// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sky_fit.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "../../core/parallel.hpp"
#include "../../core/solve.hpp"
#include "../../model/gaussians.hpp"
#include "../../model/spherical_harmonics.hpp"

namespace gs::features {
namespace {

constexpr std::size_t terms = sh_coefficients(sky_degree);

/// A smooth square of a photo without points.
struct empty_cell {
    std::uint32_t index = 0;  ///< in `photo_cells::cells`
    std::array<double, terms> basis{};
    glm::dvec3 color{0};
};

std::vector<empty_cell> empty_cells(const photo_cells& photo, const camera& taken_with, double brighter) {
    std::vector<empty_cell> found;
    for (std::size_t i = 0; i < photo.cells.size(); ++i) {
        const photo_cell& cell = photo.cells[i];
        if (cell.shows != photo_cell::content::smooth || cell.near_points) continue;
        empty_cell& one = found.emplace_back();
        one.index = static_cast<std::uint32_t>(i);
        one.color = glm::dvec3(cell.color) * std::exp2(-brighter);
        sh_basis<double>(sky_degree, photo.ray(taken_with, i), one.basis.data());
    }
    return found;
}

/// The normal equations of SH coefficients that predict the colors of cells.
struct equations {
    std::array<std::array<double, terms>, terms> left{};
    std::array<glm::dvec3, terms> right{};

    void add(const empty_cell& c, double weight) {
        for (std::size_t a = 0; a < terms; ++a) {
            right[a] += weight * c.basis[a] * (c.color - 0.5);
            for (std::size_t b = 0; b <= a; ++b) left[a][b] += weight * c.basis[a] * c.basis[b];
        }
    }
    void add(const equations& other, double weight) {
        for (std::size_t a = 0; a < terms; ++a) {
            right[a] += weight * other.right[a];
            for (std::size_t b = 0; b <= a; ++b) left[a][b] += weight * other.left[a][b];
        }
    }
    /// Solves the equations, with a small ridge penalty on the coefficients.
    std::array<glm::dvec3, terms> solution() const {
        constexpr double ridge = 0.1;  // in cells
        auto penalized = left;
        for (std::size_t k = 0; k < terms; ++k) penalized[k][k] += ridge;
        return solve(penalized, right);
    }
};

double distance(const empty_cell& c, const std::array<glm::dvec3, terms>& sky) {
    glm::dvec3 rest = c.color - 0.5;
    for (std::size_t k = 0; k < terms; ++k) rest -= c.basis[k] * sky[k];
    return std::sqrt(glm::dot(rest, rest) / 3);
}

}  // namespace

sky_fit fit_sky(const scene& of, const std::vector<photo_cells>& cells, const std::vector<double>& brighter) {
    sky_fit found;
    if (of.points.empty()) return found;
    found.has_points = true;
    std::vector<std::vector<empty_cell>> photos(cells.size());
    std::vector<std::vector<double>> rest(photos.size());
    found.predicted.resize(photos.size());
    for_each_in_parallel(photos.size(), [&](std::size_t v) {
        photos[v] = empty_cells(cells[v], of.train[v].camera, brighter.empty() ? 0.0 : brighter[v]);
        rest[v].assign(photos[v].size(), 0.0);
    });
    std::size_t all = 0, empty = 0;
    for (std::size_t v = 0; v < photos.size(); ++v) {
        all += cells[v].cells.size();
        empty += photos[v].size();
    }
    if (empty == 0) return found;

    // Reduces the weight of cells that the other photos do not predict (Geman and McClure's
    // weights).
    equations sum;
    for (int round = 0; round < 12; ++round) {
        std::vector<equations> own(photos.size());
        for_each_in_parallel(photos.size(), [&](std::size_t v) {
            for (std::size_t i = 0; i < rest[v].size(); ++i) {
                const double off = rest[v][i] / sky_tolerance;
                own[v].add(photos[v][i], 1 / ((1 + off * off) * (1 + off * off)));
            }
        });
        sum = {};
        for (const equations& e : own) sum.add(e, 1);
        for_each_in_parallel(photos.size(), [&](std::size_t v) {
            equations others = sum;
            others.add(own[v], -1);
            const auto predicted = others.solution();
            for (std::size_t i = 0; i < rest[v].size(); ++i) rest[v][i] = distance(photos[v][i], predicted);
        });
    }
    std::size_t predicted = 0;
    glm::dvec3 colors(0);
    for (std::size_t v = 0; v < photos.size(); ++v)
        for (std::size_t i = 0; i < rest[v].size(); ++i) {
            if (rest[v][i] > sky_tolerance) continue;
            ++predicted;
            found.predicted[v].push_back(photos[v][i].index);
            colors += photos[v][i].color;
        }
    found.empty = static_cast<double>(empty) / static_cast<double>(all);
    found.share = static_cast<double>(predicted) / static_cast<double>(all);
    if (predicted > 0) found.brightness = (colors.r + colors.g + colors.b) / (3.0 * double(predicted));
    for (const glm::dvec3& x : sum.solution())
        for (int c = 0; c < 3; ++c) found.coefficients.push_back(static_cast<float>(x[c]));
    return found;
}

}  // namespace gs::features
