// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "../core/median.hpp"
#include "../core/solve.hpp"

namespace gs {

/// A number with its standard error.
struct estimated {
    double value = 0;
    double error = std::numeric_limits<double>::infinity();
};

using value_column = std::vector<double>;

/// Which point and which photo the samples of a fit belong to. Those of each point are side by side.
struct fit_groups {
    std::vector<std::size_t> constant;               ///< by sample, the index of a constant of its photo
    std::vector<std::array<double, 3>> direction{};  ///< by sample, if the fit uses it
    std::vector<std::pair<std::size_t, std::size_t>> points;  ///< range of samples of each point
    std::size_t photos = 0;
    std::size_t constants_per_photo = 1;  ///< those of a photo are side by side

    std::size_t photo(std::size_t sample) const { return constant[sample] / constants_per_photo; }
};

/// Removes from columns what points and photos explain: for each photo its constants, and for each point a
/// constant and, if `Terms` is 4, a linear function of the direction. Alternates between points and photos.
template <std::size_t Terms>
class nuisance {
  public:
    nuisance(const fit_groups& groups, const value_column& weights)
        : groups_(groups),
          weights_(weights),
          basis_(weights.size()),
          of_constant_(groups.photos * groups.constants_per_photo),
          unknowns_(of_constant_.size()) {
        for (std::size_t i = 0; i < weights.size(); ++i) of_constant_[groups.constant[i]] += weights[i];
        for (const auto& [first, end] : groups.points) make_basis(first, end);
    }

    void remove_from(value_column& values) const {
        constexpr int sweeps = 40;
        value_column mean(of_constant_.size());
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            std::ranges::fill(mean, 0.0);
            for (std::size_t i = 0; i < values.size(); ++i)
                mean[groups_.constant[i]] += weights_[i] * values[i];
            for (std::size_t i = 0; i < values.size(); ++i) {
                const std::size_t v = groups_.constant[i];
                if (of_constant_[v] > 0) values[i] -= mean[v] / of_constant_[v];
            }
            for (const auto& [first, end] : groups_.points)
                for (std::size_t k = 0; k < Terms; ++k) remove(first, end, k, values);
        }
    }

    /// Returns the number of unknowns that have been fitted.
    std::size_t unknowns() const { return unknowns_; }

  private:
    /// Makes the functions of a point orthonormal under the weights, by Gram and Schmidt. Those that depend
    /// on the others become zero.
    void make_basis(std::size_t first, std::size_t end) {
        for (std::size_t k = 0; k < Terms; ++k) {
            double before = 0, after = 0;
            for (std::size_t i = first; i < end; ++i) {
                basis_[i][k] = k == 0 ? 1 : groups_.direction[i][k - 1];
                before += weights_[i] * basis_[i][k] * basis_[i][k];
            }
            for (int twice = 0; twice < 2; ++twice)
                for (std::size_t m = 0; m < k; ++m) {
                    double along = 0;
                    for (std::size_t i = first; i < end; ++i)
                        along += weights_[i] * basis_[i][m] * basis_[i][k];
                    for (std::size_t i = first; i < end; ++i) basis_[i][k] -= along * basis_[i][m];
                }
            for (std::size_t i = first; i < end; ++i) after += weights_[i] * basis_[i][k] * basis_[i][k];
            const double scale = after > 1e-6 * before ? 1 / std::sqrt(after) : 0;
            if (scale > 0) ++unknowns_;
            for (std::size_t i = first; i < end; ++i) basis_[i][k] *= scale;
        }
    }
    void remove(std::size_t first, std::size_t end, std::size_t k, value_column& values) const {
        double along = 0;
        for (std::size_t i = first; i < end; ++i) along += weights_[i] * basis_[i][k] * values[i];
        for (std::size_t i = first; i < end; ++i) values[i] -= along * basis_[i][k];
    }

    const fit_groups& groups_;
    const value_column& weights_;
    std::vector<std::array<double, Terms>> basis_;
    value_column of_constant_;
    std::size_t unknowns_;
};

/// The result of `fit`. The columns `y` and `x` have lost what points and photos explain.
template <std::size_t N>
struct regression {
    std::array<estimated, N> strengths;
    value_column residuals, weights;
    std::array<value_column, N> x;
};

template <std::size_t N>
using square_matrix = std::array<std::array<double, N>, N>;

/// Returns the standard errors of coefficients: the residuals of a photo may depend on each other
/// (cluster-robust errors, Liang and Zeger 1986). `normal` is the matrix of the normal equations.
template <std::size_t N>
std::array<double, N> standard_errors(const fit_groups& groups, const std::array<value_column, N>& x,
                                      const square_matrix<N>& normal, const value_column& residuals,
                                      const value_column& weights) {
    std::vector<std::array<double, N>> of_photo(groups.photos);
    for (std::size_t i = 0; i < residuals.size(); ++i)
        for (std::size_t a = 0; a < N; ++a)
            of_photo[groups.photo(i)][a] += weights[i] * x[a][i] * residuals[i];
    std::array<double, N> squares{};
    for (const auto& score : of_photo) {
        const auto change = solve<N, double>(normal, score);
        for (std::size_t a = 0; a < N; ++a) squares[a] += change[a] * change[a];
    }
    for (double& s : squares) s = std::sqrt(s);
    return squares;
}

/// Fits y = -strength * x by least squares with Tukey weights, after `nuisance` has been removed from both.
template <std::size_t Terms, std::size_t N>
regression<N> fit(const fit_groups& groups, const value_column& y_of,
                  const std::array<value_column, N>& regressors) {
    constexpr int rounds = 6;
    constexpr double tukey = 4.685;        // standard deviations beyond which a residual has no weight
    constexpr double least_weight = 1e-9;  // keeps equations solvable
    constexpr double least_share = 0.01;   // of the information that a strength needs
    const std::size_t n = y_of.size();
    regression<N> found;
    found.weights.assign(n, 1.0);
    for (int round = 0; round < rounds; ++round) {
        const nuisance<Terms> others(groups, found.weights);
        value_column y = y_of;
        others.remove_from(y);
        found.x = regressors;
        for (value_column& c : found.x) others.remove_from(c);
        const auto& x = found.x;
        square_matrix<N> normal{};
        std::array<double, N> right{};
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t a = 0; a < N; ++a) {
                for (std::size_t b = 0; b < N; ++b) normal[a][b] += found.weights[i] * x[a][i] * x[b][i];
                right[a] -= found.weights[i] * x[a][i] * y[i];
            }
        double information = 0;
        for (std::size_t a = 0; a < N; ++a) information += normal[a][a];
        for (std::size_t a = 0; a < N; ++a) normal[a][a] += 1e-6 * information + 1e-12;
        const auto strengths = solve<N, double>(normal, right);
        std::vector<double> sizes;
        found.residuals = y;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t a = 0; a < N; ++a) found.residuals[i] += strengths[a] * x[a][i];
            sizes.push_back(std::abs(found.residuals[i]));
        }
        const auto errors = standard_errors<N>(groups, x, normal, found.residuals, found.weights);
        // Residuals are too small because the unknowns follow the noise, and so are the errors that they
        // give.
        const double factor = static_cast<double>(n) /
                              std::max(static_cast<double>(n) - static_cast<double>(others.unknowns()), 1.0);
        for (std::size_t a = 0; a < N; ++a)
            found.strengths[a] = normal[a][a] > least_share * information
                                     ? estimated{strengths[a], factor * errors[a]}
                                     : estimated{};
        if (round + 1 == rounds) break;
        const double limit = tukey * std::max(1.4826 * median(sizes), 1e-6);
        for (std::size_t i = 0; i < n; ++i) {
            const double rest = 1 - std::pow(found.residuals[i] / limit, 2);
            found.weights[i] = rest > 0 ? rest * rest + least_weight : least_weight;
        }
    }
    return found;
}

}  // namespace gs
