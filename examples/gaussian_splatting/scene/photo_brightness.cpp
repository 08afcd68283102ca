// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "photo_brightness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "../core/median.hpp"
#include "../core/parallel.hpp"

namespace gs {
namespace {

constexpr std::size_t least_points_of_photo = 20;

/// The weighted least-squares problem log2(brightness) = point + photo, with the unknowns of the
/// points eliminated. The matrix is not stored, because there may be thousands of photos.
class photo_equations {
  public:
    explicit photo_equations(std::size_t views)
        : right_(views, 0.0), information_(views, 0.0), diagonal_(views, held) {}

    /// Adds the observations of one point, with their log2 of brightness and their weights.
    void add(const std::vector<observation>& seen, const std::vector<double>& logs,
             const std::vector<double>& weights) {
        double sum = 0, mean = 0;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            sum += weights[i];
            mean += weights[i] * logs[i];
        }
        std::vector<term> terms;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            const std::size_t v = seen[i].view;
            terms.push_back({v, weights[i]});
            right_[v] += weights[i] * (logs[i] - mean / sum);
            information_[v] += weights[i] * (1 - weights[i] / sum);
            diagonal_[v] += weights[i] * (1 - weights[i] / sum);
        }
        points_.push_back({std::move(terms), sum});
    }

    /// Solves the equations by conjugate gradients with a Jacobi preconditioner, starting from x.
    /// Stops if the residual relative to the right-hand side is at most `tolerance`, or after ten steps per
    /// photo.
    std::vector<double> solve(std::vector<double> x, double tolerance) const {
        const std::size_t n = x.size();
        const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
            return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
        };
        std::vector<double> left = right_, along(n, 0.0), scaled(n);
        const std::vector<double> first = times(x);
        for (std::size_t v = 0; v < n; ++v) left[v] -= first[v];
        const double enough = tolerance * tolerance * dot(right_, right_);
        double before = 0;
        for (std::size_t step = 0; step < 10 * n && dot(left, left) > enough; ++step) {
            for (std::size_t v = 0; v < n; ++v) scaled[v] = left[v] / diagonal_[v];
            const double now = dot(left, scaled), keep = step > 0 ? now / before : 0;
            for (std::size_t v = 0; v < n; ++v) along[v] = scaled[v] + keep * along[v];
            const std::vector<double> image = times(along);
            const double far = now / dot(along, image);
            for (std::size_t v = 0; v < n; ++v) {
                x[v] += far * along[v];
                left[v] -= far * image[v];
            }
            before = now;
        }
        return x;
    }
    const std::vector<double>& information() const { return information_; }

  private:
    /// The weight, in observations, of a term that pulls each photo's unknown toward zero. The
    /// other terms do not determine the common brightness of all photos. The weight is small, so
    /// that it does not suppress a slow drift over thousands of photos.
    static constexpr double held = 1e-9;
    struct term {
        std::size_t view;
        double weight;
    };
    struct point {
        std::vector<term> terms;
        double weight;
    };

    std::vector<double> times(const std::vector<double>& x) const {
        std::vector<double> product(x.size());
        for (std::size_t v = 0; v < x.size(); ++v) product[v] = held * x[v];
        for (const point& p : points_) {
            double mean = 0;
            for (const term& t : p.terms) mean += t.weight * x[t.view] / p.weight;
            for (const term& t : p.terms) product[t.view] += t.weight * (x[t.view] - mean);
        }
        return product;
    }

    std::vector<point> points_;
    std::vector<double> right_, information_, diagonal_;
};

/// The observations of a point in a round.
struct weighted_point {
    std::vector<double> logs;            ///< log2 of brightness
    std::vector<double> apart, weights;  ///< distances from the point's median, and weights by them

    explicit weighted_point(const std::vector<observation>& seen)
        : apart(seen.size()), weights(seen.size(), 1.0) {
        for (const observation& o : seen)
            logs.push_back(std::log2((o.color.r + o.color.g + o.color.b) / 3.0));
    }
    /// Sets the weights for the brightness of photos that an earlier round has found. Residuals beyond `most`
    /// have a smaller weight.
    void weigh(const std::vector<observation>& seen, const std::vector<double>& photos, double most) {
        std::vector<double> own, sorted;
        for (std::size_t i = 0; i < seen.size(); ++i) own.push_back(logs[i] - photos[seen[i].view]);
        sorted = own;
        const double of_point = median(sorted);
        for (std::size_t i = 0; i < seen.size(); ++i) {
            apart[i] = std::abs(own[i] - of_point);
            weights[i] = apart[i] > most ? most / apart[i] : 1;
        }
    }
};

}  // namespace

photo_brightness estimate_brightness(const observed_points& points, std::size_t photos) {
    constexpr int rounds = 10;
    constexpr double huber = 2;  // standard deviations; larger residuals have a smaller weight
    constexpr double tolerance = 1e-6, last_tolerance = 1e-12;  // earlier rounds only change weights
    constexpr double all = std::numeric_limits<double>::infinity();
    std::vector<weighted_point> weighted;
    for (const auto& seen : points) weighted.emplace_back(seen);
    std::vector<double> found_log2(photos, 0.0), information(photos, 0.0), off;
    double deviation = 0;
    for (int round = 0; round < rounds; ++round) {
        const double most = deviation > 0 ? huber * deviation : all;
        for_each_in_parallel(points.size(),
                             [&](std::size_t p) { weighted[p].weigh(points[p], found_log2, most); });
        photo_equations equations(photos);
        off.clear();
        for (std::size_t p = 0; p < points.size(); ++p) {
            off.insert(off.end(), weighted[p].apart.begin(), weighted[p].apart.end());
            equations.add(points[p], weighted[p].logs, weighted[p].weights);
        }
        deviation = 1.4826 * median(off);
        found_log2 = equations.solve(std::move(found_log2), round + 1 < rounds ? tolerance : last_tolerance);
        information = equations.information();
    }
    std::vector<std::size_t> seen_by(photos);
    for (const auto& seen : points)
        for (const observation& o : seen) ++seen_by[o.view];
    photo_brightness found{found_log2, std::vector<double>(photos, 0.0), points.size()};
    for (std::size_t v = 0; v < photos; ++v) {
        if (seen_by[v] < least_points_of_photo)
            found.log2[v] = 0;
        else
            found.error[v] = std::max(deviation, 1e-6) / std::sqrt(std::max(information[v], 1.0));
    }
    return found;
}

}  // namespace gs
