// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "tone_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../core/counter_hash.hpp"
#include "../core/median.hpp"

namespace gs {
namespace {

constexpr std::size_t channels = 3;

/// The samples of a fit: a point of `groups` is a color channel of a point of the scene.
struct tone_samples {
    fit_groups groups;
    value_column y;  ///< logarithm of the brightness

    explicit tone_samples(std::size_t photos) { groups = {{}, {}, {}, photos, channels}; }

    /// Returns the samples that `keeps` accepts, of points that have at least `least` of them.
    template <class Keeps>
    tone_samples filtered(std::size_t least, const Keeps& keeps) const {
        tone_samples some(groups.photos);
        for (const auto& [first, end] : groups.points) {
            const std::size_t before = some.y.size();
            for (std::size_t i = first; i < end; ++i)
                if (keeps(i)) some.add(groups.constant[i], y[i]);
            some.close_point(before, least);
        }
        return some;
    }
    void add(std::size_t constant, double log) {
        groups.constant.push_back(constant);
        y.push_back(log);
    }
    /// Makes the samples since `first` a point, or removes them if they are few.
    void close_point(std::size_t first, std::size_t least) {
        if (y.size() - first >= least) {
            groups.points.emplace_back(first, y.size());
        } else {
            y.resize(first);
            groups.constant.resize(first);
        }
    }
};

constexpr std::size_t least_samples = 5, least_in_half = 3;

tone_samples tone_samples_of(const scene& of, observed_points& points) {
    constexpr float similar_size = 1.6f;  // of footprints: see `keep_one_size`
    constexpr float black = 0.01f;
    tone_samples made(of.train.size());
    for (auto& seen : points) {
        std::erase_if(seen, [&](const observation& o) { return of.train[o.view].camera.is_panorama; });
        keep_one_size(seen, similar_size);
        for (std::size_t c = 0; c < channels; ++c) {
            const std::size_t first = made.y.size();
            for (const observation& o : seen) {
                const float color = o.color[static_cast<int>(c)];
                if (color > black) made.add(channels * o.view + c, std::log(static_cast<double>(color)));
            }
            made.close_point(first, least_samples);
        }
    }
    return made;
}

/// Returns the brightness that a constant per point and constants per photo predict.
value_column predicted(const tone_samples& samples) {
    const regression<1> fitted = fit<1, 1>(samples.groups, samples.y, {value_column(samples.y.size(), 0.0)});
    value_column brightness;
    for (std::size_t i = 0; i < samples.y.size(); ++i)
        brightness.push_back(std::exp(samples.y[i] - fitted.residuals[i]));
    return brightness;
}

/// Returns the typical difference from the prediction.
double noise_of(const tone_samples& samples, const value_column& brightness) {
    value_column sizes;
    for (std::size_t i = 0; i < brightness.size(); ++i)
        sizes.push_back(std::abs(std::exp(samples.y[i]) - brightness[i]));
    return 1.4826 * median(sizes);
}

/// Replaces logarithms by linear functions around the prediction. The mean of a logarithm is too small where
/// noise is large relative to the brightness, so dark colors would seem to follow a curve.
void make_linear(tone_samples& samples, const value_column& brightness) {
    for (std::size_t i = 0; i < brightness.size(); ++i)
        samples.y[i] = std::log(brightness[i]) + std::exp(samples.y[i]) / brightness[i] - 1;
}

/// Samples with the terms of the predicted brightness.
struct tone_fit {
    tone_samples samples;
    std::array<value_column, 2> terms{};

    explicit tone_fit(tone_samples of) : samples(std::move(of)) {
        for (const double b : predicted(samples)) {
            terms[0].push_back(b);
            terms[1].push_back(b * b);
        }
    }
    std::array<double, 2> solve(double* strength = nullptr) const {
        const regression<2> found = fit<1, 2>(samples.groups, samples.y, terms);
        const std::array<double, 2> factors{-found.strengths[0].value, -found.strengths[1].value};
        double squares = 0, weight = 0;
        for (std::size_t i = 0; i < samples.y.size(); ++i) {
            const double part = factors[0] * found.x[0][i] + factors[1] * found.x[1][i];
            squares += found.weights[i] * part * part;
            weight += found.weights[i];
        }
        if (strength != nullptr && weight > 0) *strength = std::sqrt(squares / weight);
        return factors;
    }
    /// Returns the multiple of these factors that fits best.
    estimated multiple_of(const std::array<double, 2>& factors) const {
        value_column sum;
        for (std::size_t i = 0; i < samples.y.size(); ++i)
            sum.push_back(-factors[0] * terms[0][i] - factors[1] * terms[1][i]);
        return fit<1, 1>(samples.groups, samples.y, {std::move(sum)}).strengths[0];
    }
};

}  // namespace

double tone_response::errors() const {
    const double error = std::hypot(halves[0].error, halves[1].error);
    return error > 0 ? (halves[0].value + halves[1].value) / error : 0;
}

bool tone_response::is_clear() const {
    return strength >= least_strength && errors() >= least_errors &&
           std::ranges::all_of(halves, [](const estimated& half) {
               return half.value >= least_agreement && half.value >= least_errors_of_half * half.error;
           });
}

double tone_response::at(double x) const { return x * std::exp(terms[0] * (x - 1) + terms[1] * (x * x - 1)); }

tone_response estimate_response(const scene& of, observed_points points) {
    tone_response found;
    tone_samples all = tone_samples_of(of, points);
    if (all.y.empty()) return found;
    const value_column brightness = predicted(all);
    const double margin = 2 * noise_of(all, brightness);
    const double darkest = 0.04 + margin, brightest = 0.94 - margin;
    const auto is_gray = [&](std::size_t i) { return brightness[i] > darkest && brightness[i] < brightest; };
    make_linear(all, brightness);
    const tone_fit whole(all.filtered(least_samples, is_gray));
    found.points = whole.samples.groups.points.size() / channels;
    if (whole.samples.y.empty()) return found;
    found.terms = whole.solve(&found.strength);
    // Photos are divided at random, because exposures may alternate.
    const auto half = [&](std::uint32_t which) {
        return tone_fit(all.filtered(least_in_half, [&](std::size_t i) {
            return is_gray(i) &&
                   counter_hash(static_cast<std::uint32_t>(all.groups.photo(i)), 0) % 2 == which;
        }));
    };
    const tone_fit first = half(0), second = half(1);
    if (first.samples.y.empty() || second.samples.y.empty()) return found;
    found.halves = {second.multiple_of(first.solve()), first.multiple_of(second.solve())};
    return found;
}

}  // namespace gs
