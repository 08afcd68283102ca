// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "../model/spherical_harmonics.hpp"
#include "../core/parallel.hpp"

namespace gs::effects {
namespace {

using points_seen = std::vector<std::vector<observation>>;

constexpr std::size_t least_views_of_point = 5, least_points_of_view = 20;
constexpr double ridges[] = {0.3, 1, 3, 10};  ///< on all but the constant, in units of an observation
constexpr float one_size = 1.6f;
constexpr double outlier = 4.0;  ///< in standard deviations: something else was in front

double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    const auto there =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), there, values.end());
    return *there;
}
double median(std::vector<double>& values) { return quantile(values, 0.5); }

/// Least squares of log2(brightness) = point + photo, the points eliminated, with a weight each. It is not
/// written out: photos may be thousands.
class photo_equations {
  public:
    explicit photo_equations(std::size_t views)
        : right_(views, 0.0), information_(views, 0.0), diagonal_(views, held) {}

    /// The observations of one point.
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

    /// By conjugate gradients with Jacobi's preconditioner, to twelve digits, from x on.
    std::vector<double> solve(std::vector<double> x) const {
        const std::size_t n = x.size();
        const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
            return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
        };
        std::vector<double> left = right_, along(n, 0.0), scaled(n);
        const std::vector<double> first = times(x);
        for (std::size_t v = 0; v < n; ++v) left[v] -= first[v];
        const double enough = 1e-24 * dot(right_, right_);
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
    /// To zero, in observations: all photos together are of no exposure. So little that it does not hold back
    /// what drifts along a walk of thousands.
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

double brightness(const observation& o) { return (o.colour.r + o.colour.g + o.colour.b) / 3.0; }

/// The observations that lie in smooth parts of the photos, at most half of them, of points that keep enough
/// of them: where the picture is rough, a point's colour depends on where exactly it is. The smoothest tenth
/// tells what is noise.
points_seen smooth_part(points_seen points) {
    std::vector<double> roughness;
    for (const auto& seen : points)
        for (const observation& o : seen) roughness.push_back(o.roughness);
    constexpr double texture = 0.04, times_noise = 1.5;
    const double noise = quantile(roughness, 0.1);
    const double limit = std::min(quantile(roughness, 0.5), texture + times_noise * noise);
    for (auto& seen : points) {
        std::erase_if(seen, [&](const observation& o) { return o.roughness > limit; });
        if (seen.size() < least_views_of_point) seen.clear();
    }
    std::erase_if(points, [](const auto& seen) { return seen.empty(); });
    return points;
}

/// Of a point's observations the most that have it about as large: from another distance its surroundings
/// blur into it.
void keep_one_size(std::vector<observation>& seen) {
    std::ranges::sort(seen, {}, [](const observation& o) { return std::pair(o.footprint, o.view); });
    std::size_t first = 0, most = 0;
    for (std::size_t i = 0, end = 0; i < seen.size(); ++i) {
        while (end < seen.size() && seen[end].footprint <= one_size * seen[i].footprint) ++end;
        if (end - i > most) {
            most = end - i;
            first = i;
        }
    }
    seen = {seen.begin() + static_cast<std::ptrdiff_t>(first),
            seen.begin() + static_cast<std::ptrdiff_t>(first + most)};
}

/// Squares of what is left of each observation by degree 0 to 3, summed over its channels; observations of
/// one point.
void add_residuals(const std::vector<observation>& seen, double ridge,
                   std::vector<std::array<double, 4>>& residuals) {
    const std::size_t n = seen.size();
    glm::dvec3 mean(0);
    for (const observation& o : seen) mean += glm::dvec3(o.colour) / double(n);
    std::vector<std::array<double, 16>> rows(n);
    std::array<double, 16> centre{};
    for (std::size_t i = 0; i < n; ++i) {
        sh_basis<double>(3, glm::dvec3(seen[i].direction), rows[i].data());
        for (std::size_t k = 0; k < 16; ++k) centre[k] += rows[i][k] / double(n);
    }
    // About their means, so that the constant is not held back.
    for (auto& row : rows)
        for (std::size_t k = 0; k < 16; ++k) row[k] -= centre[k];
    std::vector<std::array<double, 4>> left(n);
    for (int degree = 0; degree <= 3; ++degree) {
        const auto size = static_cast<std::size_t>((degree + 1) * (degree + 1) - 1);
        // The normal equations' Cholesky factor, bands 1 to `degree`.
        double factor[15][15] = {};
        for (std::size_t a = 0; a < size; ++a)
            for (std::size_t b = 0; b <= a; ++b) {
                double sum = a == b ? ridge : 0;
                for (const auto& row : rows) sum += row[a + 1] * row[b + 1];
                for (std::size_t k = 0; k < b; ++k) sum -= factor[a][k] * factor[b][k];
                factor[a][b] = a == b ? std::sqrt(sum) : sum / factor[b][b];
            }
        // Each row by the inverse factor: the hat matrix is W W^T, besides 1/n of the constant.
        std::vector<std::array<double, 15>> whitened(n);
        std::array<glm::dvec3, 15> projected{};
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t a = 0; a < size; ++a) {
                double sum = rows[i][a + 1];
                for (std::size_t k = 0; k < a; ++k) sum -= factor[a][k] * whitened[i][k];
                whitened[i][a] = sum / factor[a][a];
                projected[a] += whitened[i][a] * (glm::dvec3(seen[i].colour) - mean);
            }
        for (std::size_t i = 0; i < n; ++i) {
            double own = 1 / double(n);  // what an observation adds to its own prediction
            glm::dvec3 rest = glm::dvec3(seen[i].colour) - mean;
            for (std::size_t a = 0; a < size; ++a) {
                own += whitened[i][a] * whitened[i][a];
                rest -= whitened[i][a] * projected[a];
            }
            rest /= 1 - own;
            left[i][static_cast<std::size_t>(degree)] = glm::dot(rest, rest) / 3;
        }
    }
    residuals.insert(residuals.end(), left.begin(), left.end());
}

std::array<double, 4> unexplained_with(const points_seen& points, double ridge) {
    std::vector<std::vector<std::array<double, 4>>> residuals(points.size());
    for_each_in_parallel(points.size(), [&](std::size_t p) {
        if (points[p].size() >= least_views_of_point) add_residuals(points[p], ridge, residuals[p]);
    });
    std::vector<double> sizes;
    for (const auto& of_point : residuals)
        for (const auto& r : of_point) sizes.push_back(r[0]);
    const double limit = outlier * outlier * 1.4826 * 1.4826 * median(sizes);
    std::array<double, 4> sum{};
    for (const auto& of_point : residuals)
        for (const auto& r : of_point)
            for (std::size_t d = 0; d < 4; ++d) sum[d] += std::min(r[d], limit) / double(sizes.size());
    return sum;
}

void count_masks(const scene& of, evidence& found) {
    std::size_t out = 0, all = 0;
    found.photos = of.train.size();
    for (const view& v : of.train) {
        found.masked_photos += v.pixels.has_mask ? 1 : 0;
        const std::size_t pixels = v.pixels.rgba.size() / 4;
        all += pixels;
        for (std::size_t i = 0; v.pixels.has_mask && i < pixels; ++i) out += v.pixels.is_masked(i) ? 1 : 0;
    }
    found.masked_share = static_cast<double>(out) / static_cast<double>(all);
}

void look_at_lenses(const scene& of, evidence& found) {
    for (const view& v : of.train) {
        const camera& c = v.camera;
        if (!c.fisheye) continue;
        ++found.fisheye_photos;
        const double wide =
            std::hypot(std::max(c.cx, c.width - c.cx) / c.fx, std::max(c.cy, c.height - c.cy) / c.fy);
        found.widest = std::max(found.widest, 360 / std::numbers::pi * c.fisheye->angle(wide));
    }
}

}  // namespace

exposure_estimate exposures(const points_seen& points, std::size_t views) {
    constexpr int rounds = 10;
    constexpr double huber = 2;  // standard deviations, from which a residual counts less
    std::vector<double> brighter(views, 0.0), information(views, 0.0), off;
    double deviation = 0;
    for (int round = 0; round < rounds; ++round) {
        photo_equations equations(views);
        off.clear();
        for (const auto& seen : points) {
            std::vector<double> logs, own, weights(seen.size(), 1.0);
            for (const observation& o : seen) {
                logs.push_back(std::log2(brightness(o)));
                own.push_back(logs.back() - brighter[o.view]);
            }
            const std::vector<double> all = own;
            const double of_point = median(own);
            for (std::size_t i = 0; i < seen.size(); ++i) {
                const double apart = std::abs(all[i] - of_point);
                off.push_back(apart);
                if (deviation > 0 && apart > huber * deviation) weights[i] = huber * deviation / apart;
            }
            equations.add(seen, logs, weights);
        }
        deviation = 1.4826 * median(off);
        brighter = equations.solve(std::move(brighter));
        information = equations.information();
    }
    std::vector<std::size_t> seen_by(views);
    for (const auto& seen : points)
        for (const observation& o : seen) ++seen_by[o.view];
    exposure_estimate found{brighter, std::vector<double>(views, 0.0)};
    for (std::size_t v = 0; v < views; ++v) {
        if (seen_by[v] < least_points_of_view)
            found.brighter[v] = 0;
        else
            found.error[v] = std::max(deviation, 1e-6) / std::sqrt(std::max(information[v], 1.0));
    }
    return found;
}

std::array<double, 4> unexplained_by_direction(const points_seen& points) {
    std::array<double, 4> least;
    least.fill(std::numeric_limits<double>::infinity());
    for (const double ridge : ridges) {
        const std::array<double, 4> by_ridge = unexplained_with(points, ridge);
        for (std::size_t d = 0; d < 4; ++d) least[d] = std::min(least[d], by_ridge[d]);
    }
    return least;
}

evidence gather_from_points(const scene& of) {
    evidence found;
    found.has_points = !of.points.empty();
    points_seen points = observe_points(of);
    std::vector<double> ratios;
    for (const auto& seen : points) {
        if (seen.size() < least_views_of_point) continue;
        const auto [least, most] = std::ranges::minmax(seen, {}, &observation::footprint);
        ratios.push_back(most.footprint / least.footprint);
    }
    found.scale_points = ratios.size();
    if (!ratios.empty()) found.scale_ratio = median(ratios);
    points = smooth_part(std::move(points));
    found.exposure_points = points.size();
    if (points.empty()) return found;

    const exposure_estimate exposure = exposures(points, of.train.size());
    found.brighter = exposure.brighter;
    std::vector<double> errors;
    double square = 0;
    for (std::size_t v = 0; v < of.train.size(); ++v) {
        if (exposure.error[v] == 0) continue;
        errors.push_back(exposure.error[v]);
        square += exposure.brighter[v] * exposure.brighter[v];
    }
    if (!errors.empty()) {
        found.exposure_spread = std::sqrt(square / double(errors.size()));
        found.exposure_error = median(errors);
    }
    for (auto& seen : points) {
        std::erase_if(seen, [&](const observation& o) { return exposure.error[o.view] == 0; });  // not known
        keep_one_size(seen);
        for (observation& o : seen) o.colour *= static_cast<float>(std::exp2(-exposure.brighter[o.view]));
    }
    std::erase_if(points, [](const auto& seen) { return seen.size() < least_views_of_point; });
    found.direction_points = points.size();
    if (!points.empty()) found.unexplained = unexplained_by_direction(points);
    return found;
}

evidence gather(const scene& of) {
    evidence found = gather_from_points(of);
    found.alpha = of.has_alpha;
    count_masks(of, found);
    look_at_lenses(of, found);
    found.depth = compare_depths(of);
    found.sky = find_sky(of, {});
    // A sky that is overexposed is white in every photo: then that told more.
    if (!found.brighter.empty()) {
        sky_evidence evened = find_sky(of, found.brighter);
        if (evened.share > found.sky.share) found.sky = std::move(evened);
    }
    return found;
}

}  // namespace gs::effects
