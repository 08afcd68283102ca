// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lens_falloff.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "../core/median.hpp"
#include "../core/solve.hpp"
#include "image_radius.hpp"

namespace gs {
namespace {

constexpr float one_size = 1.6f;  ///< of footprints: see `keep_one_size`
constexpr std::size_t least_observations = 5;

/// An observation of a point.
struct lens_sample {
    std::size_t view;
    double square_radius;
    std::size_t side;         ///< see `lens_falloff::sides`
    std::array<double, 4> y;  ///< logarithms of red, green, blue and their mean
    std::array<double, 3> direction;
};

/// The samples, those of each point side by side.
struct lens_samples {
    std::vector<lens_sample> all;
    std::vector<std::pair<std::size_t, std::size_t>> points;  ///< range of each point
    std::size_t views = 0;
};

using value_column = std::vector<double>;

lens_samples samples_of(const scene& of, observed_points& points) {
    lens_samples made;
    made.views = of.train.size();
    for (auto& seen : points) {
        std::erase_if(seen, [&](const observation& o) { return of.train[o.view].camera.is_panorama; });
        keep_one_size(seen, one_size);
        if (seen.size() < least_observations) continue;
        const std::size_t first = made.all.size();
        for (const observation& o : seen) {
            const camera& c = of.train[o.view].camera;
            const auto place = c.see(of.points[o.point].position).value();
            const double x = place.x - c.cx, y = place.y - c.cy;
            lens_sample s{.view = o.view,
                          .square_radius = square_radius(c, place.x, place.y),
                          .side = std::abs(x) > std::abs(y) ? (x > 0 ? 0u : 1u) : (y > 0 ? 2u : 3u),
                          .y = {},
                          .direction = {}};
            double sum = 0;
            for (int k = 0; k < 3; ++k) {
                const auto i = static_cast<std::size_t>(k);
                s.y[i] = std::log(static_cast<double>(o.color[k]));
                s.direction[i] = static_cast<double>(o.direction[k]);
                sum += static_cast<double>(o.color[k]);
            }
            s.y[3] = std::log(sum / 3);
            made.all.push_back(s);
        }
        made.points.emplace_back(first, made.all.size());
    }
    return made;
}

/// Removes from columns what points and photos explain: for each photo a constant, and for each point a
/// constant and, if `Terms` is 4, a linear function of the direction. Alternates between points and photos.
template <std::size_t Terms>
class nuisance {
  public:
    nuisance(const lens_samples& samples, const value_column& weights)
        : samples_(samples),
          weights_(weights),
          basis_(samples.all.size()),
          of_view_(samples.views),
          unknowns_(samples.views) {
        for (std::size_t i = 0; i < weights.size(); ++i) of_view_[samples.all[i].view] += weights[i];
        for (const auto& [first, end] : samples.points) make_basis(first, end);
    }

    void remove_from(value_column& values) const {
        constexpr int sweeps = 40;
        value_column mean(samples_.views);
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            std::ranges::fill(mean, 0.0);
            for (std::size_t i = 0; i < values.size(); ++i)
                mean[samples_.all[i].view] += weights_[i] * values[i];
            for (std::size_t i = 0; i < values.size(); ++i) {
                const std::size_t v = samples_.all[i].view;
                if (of_view_[v] > 0) values[i] -= mean[v] / of_view_[v];
            }
            for (const auto& [first, end] : samples_.points)
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
                basis_[i][k] = k == 0 ? 1 : samples_.all[i].direction[k - 1];
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

    const lens_samples& samples_;
    const value_column& weights_;
    std::vector<std::array<double, Terms>> basis_;
    value_column of_view_;
    std::size_t unknowns_;
};

template <std::size_t N>
struct regression {
    std::array<estimated, N> strengths;
    value_column residuals, weights;
};

template <std::size_t N>
using square_matrix = std::array<std::array<double, N>, N>;

/// Returns the standard errors of coefficients: the residuals of a photo may depend on each other
/// (cluster-robust errors, Liang and Zeger 1986). `normal` is the matrix of the normal equations.
template <std::size_t N>
std::array<double, N> standard_errors(const lens_samples& samples, const std::array<value_column, N>& x,
                                      const square_matrix<N>& normal, const value_column& residuals,
                                      const value_column& weights) {
    std::vector<std::array<double, N>> of_view(samples.views);
    for (std::size_t i = 0; i < residuals.size(); ++i)
        for (std::size_t a = 0; a < N; ++a)
            of_view[samples.all[i].view][a] += weights[i] * x[a][i] * residuals[i];
    std::array<double, N> squares{};
    for (const auto& score : of_view) {
        const auto change = solve<N, double>(normal, score);
        for (std::size_t a = 0; a < N; ++a) squares[a] += change[a] * change[a];
    }
    for (double& s : squares) s = std::sqrt(s);
    return squares;
}

/// Fits y = -strength * x by robust least squares, after `nuisance` has been removed from both.
template <std::size_t Terms, std::size_t N>
regression<N> fit(const lens_samples& samples, std::size_t channel,
                  const std::array<value_column, N>& regressors) {
    constexpr int rounds = 6;
    constexpr double tukey = 4.685;        // standard deviations beyond which a residual has no weight
    constexpr double least_weight = 1e-9;  // keeps equations solvable
    constexpr double least_share = 0.01;   // of the information that a strength needs
    const std::size_t n = samples.all.size();
    regression<N> found;
    found.weights.assign(n, 1.0);
    for (int round = 0; round < rounds; ++round) {
        const nuisance<Terms> others(samples, found.weights);
        value_column y;
        for (const lens_sample& s : samples.all) y.push_back(s.y[channel]);
        others.remove_from(y);
        std::array<value_column, N> x = regressors;
        for (value_column& c : x) others.remove_from(c);
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
        const auto errors = standard_errors<N>(samples, x, normal, found.residuals, found.weights);
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

std::vector<std::pair<double, double>> profile_of(const lens_samples& samples, const regression<1>& fitted) {
    constexpr double least_weight = 20;  // of the observations of a tenth
    struct tenth {
        double weight = 0, radius = 0, log = 0;
    };
    std::array<tenth, 10> tenths;
    for (std::size_t i = 0; i < samples.all.size(); ++i) {
        const double u = samples.all[i].square_radius, radius = std::sqrt(u), w = fitted.weights[i];
        tenth& t = tenths[std::min<std::size_t>(static_cast<std::size_t>(10 * radius), 9)];
        t.weight += w;
        t.radius += w * radius;
        t.log += w * (fitted.residuals[i] - fitted.strengths[0].value * u);
    }
    std::vector<std::pair<double, double>> profile;
    for (const tenth& t : tenths)
        if (t.weight >= least_weight) profile.emplace_back(t.radius / t.weight, std::exp(t.log / t.weight));
    return profile;
}

}  // namespace

bool lens_falloff::is_strong() const {
    return strength.value >= least_strength && strength.value >= least_errors * strength.error;
}

bool lens_falloff::is_clear() const {
    const auto agrees = [&](const estimated& test) {
        return test.value + test_errors * test.error >= least_agreement * strength.value;
    };
    return is_strong() && std::ranges::all_of(sides, [&](const estimated& side) { return agrees(side); }) &&
           agrees(for_direction);
}

std::array<double, 3> lens_falloff::at(double square_radius) const {
    std::array<double, 3> factors;
    for (std::size_t c = 0; c < 3; ++c) factors[c] = std::exp(-channels[c] * square_radius);
    return factors;
}

lens_falloff estimate_falloff(const scene& of, observed_points points) {
    lens_falloff found;
    const lens_samples samples = samples_of(of, points);
    found.points = samples.points.size();
    if (samples.all.empty()) return found;
    value_column radius;
    std::array<value_column, 4> by_side;
    for (const lens_sample& s : samples.all) {
        radius.push_back(s.square_radius);
        for (std::size_t side = 0; side < 4; ++side)
            by_side[side].push_back(s.side == side ? s.square_radius : 0);
    }
    const std::array<value_column, 1> alone{radius};
    const regression<1> all = fit<1>(samples, 3, alone);
    found.strength = all.strengths[0];
    found.profile = profile_of(samples, all);
    for (std::size_t c = 0; c < 3; ++c) found.channels[c] = fit<1>(samples, c, alone).strengths[0].value;
    found.sides = fit<1>(samples, 3, by_side).strengths;
    found.for_direction = fit<4>(samples, 3, alone).strengths[0];
    return found;
}

void remove_falloff(const scene& of, const lens_falloff& falloff, observed_points& points) {
    for (auto& seen : points)
        for (observation& o : seen) {
            const camera& c = of.train[o.view].camera;
            if (c.is_panorama) continue;
            const auto place = c.see(of.points[o.point].position).value();
            const auto factors = falloff.at(square_radius(c, place.x, place.y));
            for (int k = 0; k < 3; ++k)
                o.color[k] /= static_cast<float>(factors[static_cast<std::size_t>(k)]);
        }
}

}  // namespace gs
