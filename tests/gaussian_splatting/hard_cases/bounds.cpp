// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "cases.hpp"
#include "render/geometry/splat.hpp"

namespace hard_cases {

namespace {

bool same(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
               return x == y || (std::isnan(x) && std::isnan(y));
           });
}

/// The photo over the background, as the loss sees it.
double photo_at(const render_case& q, std::size_t channel, std::size_t pixel) {
    const std::uint8_t* p = q.view.pixels.rgba.data() + 4 * pixel;
    return (p[channel] + (255 - p[3]) * static_cast<double>(q.background[channel])) / 255;
}

}  // namespace

double largest(const std::vector<double>& a) {
    double most = 0;
    for (const double x : a) most = std::max(most, std::abs(x));
    return most;
}

bool all_finite(const std::vector<double>& a) {
    return std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); });
}

bool all_finite(const render_result& a) {
    return all_finite(a.render) && std::isfinite(a.loss) &&
           std::all_of(a.gradients.begin(), a.gradients.end(),
                       [](const std::vector<double>& g) { return all_finite(g); });
}

bool same(const render_result& a, const render_result& b) {
    if (!same(a.render, b.render) || a.loss != b.loss) return false;
    for (std::size_t p = 0; p < gs::parameter_count; ++p)
        if (!same(a.gradients[p], b.gradients[p])) return false;
    return true;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double most = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        const double d = std::abs(a[i] - b[i]);
        most = std::isfinite(d) ? std::max(most, d) : std::numeric_limits<double>::infinity();
    }
    return most;
}

double distance(const render_result& a, const render_result& b, const render_case& q) {
    if (q.weights.empty()) return distance(a.render, b.render);
    std::vector<double> x = a.render, y = b.render;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (q.weights[i % q.pixels()] == 0) x[i] = y[i] = 0;
    return distance(x, y);
}

void agreement::operator+=(const agreement& other) {
    error_over_bound = std::max(error_over_bound, other.error_over_bound);
    cosine = std::min(cosine, other.cosine);
    bias = std::max(bias, other.bias);
}

agreement compare(const std::vector<double>& got, const std::vector<double>& expected) {
    if (got.size() != expected.size() || !all_finite(got)) return {infinity, -1, infinity};
    const double most = largest(expected);
    agreement a;
    double product = 0, square = 0, expected_square = 0, error = 0, mass = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
        const double x = got[i], y = expected[i], bound = 1e-3 * std::abs(y) + 1e-5 * most;
        if (x != y) a.error_over_bound = std::max(a.error_over_bound, std::abs(x - y) / bound);
        product += x * y;
        square += x * x;
        expected_square += y * y;
        error += x - y;
        mass += std::abs(y);
    }
    if (square > 0 && expected_square > 0)
        a.cosine = product / (std::sqrt(square) * std::sqrt(expected_square));
    else if (square > 0 || expected_square > 0)
        a.cosine = 0;
    if (error != 0) a.bias = std::abs(error) / mass;
    return a;
}

agreement compare(const render_result& got, const render_result& expected) {
    agreement all;
    for (std::size_t p = 0; p < gs::parameter_count; ++p)
        all += compare(got.gradients[p], expected.gradients[p]);
    return all;
}

std::string excess(const std::vector<double>& got, const std::vector<double>& expected) {
    constexpr std::size_t least_for_bias = 32;
    const agreement a = compare(got, expected);
    std::ostringstream said;
    if (!(a.error_over_bound <= 1)) said << "an error of " << a.error_over_bound << " times its bound; ";
    if (!(a.cosine >= 0.99999)) said << "a cosine of " << a.cosine << "; ";
    if (got.size() >= least_for_bias && !(a.bias <= 1e-4)) said << "a bias of " << a.bias << "; ";
    return said.str();
}

std::string excess(const render_result& got, const render_result& expected) {
    std::string said;
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        const std::string here = excess(got.gradients[p], expected.gradients[p]);
        if (!here.empty()) said += parameter_names[p] + ": " + here;
    }
    return said;
}

std::vector<double> off_thresholds(const render_case& q, double margin, std::uint32_t depth_margin) {
    using namespace gs::raster;
    const int width = q.view.camera.width, height = q.view.camera.height;
    const bool around = q.view.camera.is_panorama;
    std::vector<double> weights(q.pixels(), 1.0), behind(q.pixels(), 1.0);
    std::vector<std::uint32_t> depths(q.pixels(), 0);  // of the last splat that a pixel saw
    std::vector<projected_splat> splats = reference().project(q);
    std::erase_if(splats, [](const projected_splat& s) { return !s.drawn; });
    std::stable_sort(splats.begin(), splats.end(),
                     [](const auto& a, const auto& b) { return a.depth < b.depth; });
    const auto near = [](double value, double threshold, double within) {
        return std::abs(value / threshold - 1) < within;
    };
    // Of alpha; in 1 - alpha, and so in T, an error grows up to a hundred times.
    const double margin_of_T = 100 * margin;
    const auto from = [](double first, int end) {
        return static_cast<int>(std::clamp(std::floor(first), 0.0, static_cast<double>(end)));
    };
    for (const projected_splat& s : splats) {
        // u = p dx and v = q dy + r dx, neither further from 0 than the root of the cutoff.
        const double far = std::sqrt(s.cutoff) * (1 + margin), dx = far / s.p,
                     dy = (far + std::abs(s.r) * dx) / s.q;
        for (int y = from(s.y - dy - 1, height); y < from(s.y + dy + 2, height); ++y)
            for (int x = around ? 0 : from(s.x - dx - 1, width);
                 x < (around ? width : from(s.x + dx + 2, width)); ++x) {
                const auto pixel = static_cast<std::size_t>(y * width + x);
                double& T = behind[pixel];
                if (T == 0) continue;
                double along = x + 0.5 - s.x;
                if (around) along = nearest_offset<double>(along, width);
                const double u = s.p * along, v = s.q * (y + 0.5 - s.y) + s.r * along;
                const double full = s.opacity * std::exp2(-(u * u + v * v));
                const double next = T * (1 - std::min(full, most_alpha));
                if (near(full, least_alpha, margin) || near(full, most_alpha, margin) ||
                    (full >= least_alpha && near(next, least_transmittance, margin_of_T)))
                    weights[pixel] = 0;
                // Rounding may swap the two ways around a panorama.
                if (around && full >= least_alpha * (1 - margin) &&
                    std::abs(std::abs(along) - 0.5 * width) < 1e-3)
                    weights[pixel] = 0;
                if (full < least_alpha) continue;
                // The sort key is a float: rounding may swap two of almost one depth.
                if (s.depth - depths[pixel] < depth_margin) weights[pixel] = 0;
                depths[pixel] = s.depth;
                T = next < least_transmittance ? 0 : next;
            }
    }
    const std::vector<double> render = reference().render(q).render;
    for (std::size_t i = 0; i < render.size(); ++i) {
        const double apart = std::abs(render[i] - photo_at(q, i / q.pixels(), i % q.pixels()));
        // Nothing seen, or nothing but black on black, is the same in every precision.
        if (apart != 0 && behind[i % q.pixels()] < 1 && apart < 0.1 * margin) weights[i % q.pixels()] = 0;
    }
    return weights;
}

}  // namespace hard_cases
