// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "sky_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "../../core/parallel.hpp"
#include "../../model/gaussians.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../../scene/view_photo.hpp"

namespace gs::features {
namespace {

constexpr int cells_along = 32;
constexpr double smooth = 0.04;  ///< largest standard deviation within a cell, without noise
constexpr std::size_t terms = sh_coefficients(sky_degree);

/// A square of a photo without points.
struct cell {
    int left, top, side;
    std::array<double, terms> basis{};
    glm::dvec3 color{0};
};

/// Returns the mean color of a square, or nothing if it is not smooth or not opaque. Smoothness is
/// measured on the averages of rows and columns, in which noise alone is small.
std::optional<glm::dvec3> smooth_color(const image& photo, int left, int top, int side) {
    std::vector<glm::dvec3> columns(static_cast<std::size_t>(side)), rows(static_cast<std::size_t>(side));
    glm::dvec3 mean(0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const std::uint8_t* rgba =
                &photo.rgba[4 * (static_cast<std::size_t>(top + y) * static_cast<std::size_t>(photo.width) +
                                 static_cast<std::size_t>(left + x))];
            if (rgba[3] != 255) return std::nullopt;
            const glm::dvec3 color = glm::dvec3(rgba[0], rgba[1], rgba[2]) / (255.0 * side);
            columns[static_cast<std::size_t>(x)] += color;
            rows[static_cast<std::size_t>(y)] += color;
            mean += color / double(side);
        }
    double square = 0;
    for (const auto* lines : {&columns, &rows})
        for (const glm::dvec3& line : *lines) square += glm::dot(line - mean, line - mean) / (3.0 * side);
    if (square > smooth * smooth) return std::nullopt;
    return mean;
}

/// The smooth cells of one photo that have no points, and the number of all cells.
struct photo_cells {
    std::vector<cell> empty;
    std::size_t all = 0;
};

photo_cells cells_of(const camera& c, const image& photo, const std::vector<colored_point>& points) {
    const int side = std::max(4, std::max(c.width, c.height) / cells_along);
    const int across = c.width / side, down = c.height / side;
    photo_cells found;
    if (across < 1 || down < 1) return found;
    // Marks cells with points in them or in a neighbor.
    std::vector<char> near_points(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), 0);
    for (const colored_point& point : points) {
        const auto p = c.see(point.position);
        if (!p) continue;
        const double x = p->x / side, y = p->y / side;
        if (!(x > -1 && y > -1 && x < across + 1 && y < down + 1)) continue;
        for (int row = std::max(0, static_cast<int>(std::floor(y)) - 1);
             row <= std::min(down - 1, static_cast<int>(std::floor(y)) + 1); ++row)
            for (int column = std::max(0, static_cast<int>(std::floor(x)) - 1);
                 column <= std::min(across - 1, static_cast<int>(std::floor(x)) + 1); ++column)
                near_points[static_cast<std::size_t>(row * across + column)] = 1;
    }
    found.all = near_points.size();
    for (int row = 0; row < down; ++row)
        for (int column = 0; column < across; ++column) {
            if (near_points[static_cast<std::size_t>(row * across + column)] != 0) continue;
            const auto color = smooth_color(photo, column * side, row * side, side);
            if (!color) continue;
            cell one{.left = column * side, .top = row * side, .side = side, .color = *color};
            sh_basis<double>(sky_degree, c.ray((column + 0.5) * side, (row + 0.5) * side), one.basis.data());
            found.empty.push_back(one);
        }
    return found;
}

/// The normal equations of SH coefficients that predict the colors of cells.
struct equations {
    std::array<std::array<double, terms>, terms> left{};
    std::array<glm::dvec3, terms> right{};

    void add(const cell& c, double weight) {
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
    /// Solves the equations by Cholesky factorization, with a small ridge penalty on the
    /// coefficients.
    std::array<glm::dvec3, terms> solve() const {
        constexpr double ridge = 0.1;  // in cells
        auto factor = left;
        auto x = right;
        for (std::size_t a = 0; a < terms; ++a) {
            factor[a][a] += ridge;
            for (std::size_t b = 0; b <= a; ++b) {
                for (std::size_t k = 0; k < b; ++k) factor[a][b] -= factor[a][k] * factor[b][k];
                factor[a][b] = a == b ? std::sqrt(factor[a][a]) : factor[a][b] / factor[b][b];
            }
            for (std::size_t k = 0; k < a; ++k) x[a] -= factor[a][k] * x[k];
            x[a] /= factor[a][a];
        }
        for (std::size_t a = terms; a-- > 0;) {
            for (std::size_t k = a + 1; k < terms; ++k) x[a] -= factor[k][a] * x[k];
            x[a] /= factor[a][a];
        }
        return x;
    }
};

double distance(const cell& c, const std::array<glm::dvec3, terms>& sky) {
    glm::dvec3 rest = c.color - 0.5;
    for (std::size_t k = 0; k < terms; ++k) rest -= c.basis[k] * sky[k];
    return std::sqrt(glm::dot(rest, rest) / 3);
}

}  // namespace

sky_fit fit_sky(const scene& of, const std::vector<double>& brighter) {
    sky_fit found;
    if (of.points.empty()) return found;
    found.has_points = true;
    std::vector<photo_cells> photos(of.train.size());
    for_each_in_parallel(photos.size(), [&](std::size_t v) {
        photos[v] = cells_of(of.train[v].camera, view_photo(of.train[v]).pixels(), of.points);
        if (brighter.empty()) return;
        for (cell& c : photos[v].empty) c.color *= std::exp2(-brighter[v]);
    });
    std::vector<std::vector<double>> rest(photos.size());
    std::size_t all = 0, empty = 0;
    for (std::size_t v = 0; v < photos.size(); ++v) {
        rest[v].assign(photos[v].empty.size(), 0.0);
        all += photos[v].all;
        empty += photos[v].empty.size();
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
                own[v].add(photos[v].empty[i], 1 / ((1 + off * off) * (1 + off * off)));
            }
        });
        sum = {};
        for (const equations& e : own) sum.add(e, 1);
        for_each_in_parallel(photos.size(), [&](std::size_t v) {
            equations others = sum;
            others.add(own[v], -1);
            const auto predicted = others.solve();
            for (std::size_t i = 0; i < rest[v].size(); ++i)
                rest[v][i] = distance(photos[v].empty[i], predicted);
        });
    }
    std::size_t predicted = 0;
    glm::dvec3 colors(0);
    found.cells.resize(photos.size());
    for (std::size_t v = 0; v < photos.size(); ++v)
        for (std::size_t i = 0; i < rest[v].size(); ++i) {
            const cell& c = photos[v].empty[i];
            found.cells[v].push_back({c.left, c.top, c.side, rest[v][i] <= sky_tolerance});
            if (rest[v][i] > sky_tolerance) continue;
            ++predicted;
            colors += c.color;
        }
    found.empty = static_cast<double>(empty) / static_cast<double>(all);
    found.share = static_cast<double>(predicted) / static_cast<double>(all);
    if (predicted > 0) found.brightness = (colors.r + colors.g + colors.b) / (3.0 * double(predicted));
    for (const glm::dvec3& x : sum.solve())
        for (int c = 0; c < 3; ++c) found.coefficients.push_back(static_cast<float>(x[c]));
    return found;
}

}  // namespace gs::features
