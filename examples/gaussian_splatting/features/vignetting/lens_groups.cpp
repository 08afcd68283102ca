// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lens_groups.hpp"

#include <algorithm>
#include <cmath>

namespace gs::features {
namespace {

bool are_close(double a, double b, double part) { return std::abs(a - b) <= part * std::max(a, b); }

bool have_one_lens(const camera& a, const camera& b) {
    constexpr double of_size = 0.02;   // undistortion crops photos by different numbers of pixels
    constexpr double of_focal = 0.05;  // a zoom changes it more, and calibration of each photo less
    return a.lens() == b.lens() &&
           are_close(std::max(a.width, a.height), std::max(b.width, b.height), of_size) &&
           are_close(std::min(a.width, a.height), std::min(b.width, b.height), of_size) &&
           are_close(std::sqrt(a.fx * a.fy), std::sqrt(b.fx * b.fy), of_focal);
}

}  // namespace

lens_groups::lens_groups(const std::vector<view>& training) {
    for (const view& v : training)
        if (!v.camera.is_panorama && !of(v.camera)) first_.push_back(v.camera);
}

std::optional<std::size_t> lens_groups::of(const camera& c) const {
    const auto found =
        std::ranges::find_if(first_, [&](const camera& first) { return have_one_lens(first, c); });
    if (found == first_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - first_.begin());
}

}  // namespace gs::features
