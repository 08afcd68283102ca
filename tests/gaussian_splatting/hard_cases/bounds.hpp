// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "backend.hpp"

namespace hard_cases {

/// How near one array came to another: the largest error over its bound, which is 1e-3 of the element and
/// 1e-5 of the largest; the cosine of the angle between them; and the sum of the errors over that of the
/// sizes.
struct agreement {
    double error_over_bound = 0, cosine = 1, bias = 0;

    /// The worse of both.
    void operator+=(const agreement& other);
};
agreement compare(const std::vector<double>& got, const std::vector<double>& expected);
/// The worst of the parameters.
agreement compare(const render_result& got, const render_result& expected);

/// What of a result in float exceeds the bounds: each gradient that of `agreement`, all of a parameter
/// together a cosine of 0.99999 and, if they are 32 or more, a bias of 1e-4. In words; nothing if nothing
/// does.
std::string excess(const render_result& got, const render_result& expected);

/// Does the same for one array.
std::string excess(const std::vector<double>& got, const std::vector<double>& expected);

/// The largest distance between elements; infinite where one is not finite or the sizes differ.
double distance(const std::vector<double>& a, const std::vector<double>& b);

/// The same of two images, where the case has weights only in the pixels that have one.
double distance(const render_result& a, const render_result& b, const render_case& q);

/// The largest |a|.
double largest(const std::vector<double>& a);

bool all_finite(const std::vector<double>& a);
/// Image, loss and gradients.
bool all_finite(const render_result& a);

/// Bit for bit, but that all NaN are alike.
bool same(const render_result& a, const render_result& b);

/// Weights of 0 for the pixels in which float and double may decide differently for their rounding: where a
/// splat's alpha lies within a relative `margin` of the least that is drawn or of the cap, the transmittance
/// within a hundred times that of the least that goes on, a channel under some splat within a tenth of
/// `margin` of its photo, where the loss has its kink, or the depths of two splats in a row less than
/// `depth_margin` ulp apart. 1 elsewhere. The decisions are looked for in double.
std::vector<double> off_thresholds(const render_case& q, double margin, std::uint32_t depth_margin = 0);

}  // namespace hard_cases
