// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "../metrics/image_quality.hpp"

namespace gs::evaluate {

/// The measurements of a view. See docs/reference/metrics.md.
struct view_values {
    train::image_quality quality{};
    std::optional<double> ssim_interior{};  ///< see interior_ssim.hpp
    std::optional<double> psnr_8bit{};      ///< see png_psnr.hpp
    std::optional<double> lpips{};          ///< see lpips/lpips.hpp
    std::optional<double> fitted_psnr{};    ///< see fit_exposure.hpp
    /// PSNR of the right half of the photo after the pose was refined on the left half: see
    /// `train::learned_cameras`.
    std::optional<double> refined_psnr{};
};

/// A view and its measurements.
struct view_quality : view_values {
    std::string name{};
};

/// A number that reports list for each view.
struct view_measure {
    const char* key;      ///< in metrics.json and metrics.csv
    const char* heading;  ///< in metrics.md
    const char* format;   ///< for printf
    bool is_standard;     ///< otherwise, reports leave it out if no view has it
    std::optional<double> (*of)(const view_values&);
};

/// All measures, in the order of reports.
inline constexpr std::array<view_measure, 7> view_measures{{
    {"psnr", "PSNR (dB)", "%.2f", true, [](const view_values& v) { return std::optional(v.quality.psnr()); }},
    {"ssim", "SSIM", "%.4f", true, [](const view_values& v) { return std::optional(v.quality.ssim); }},
    {"ssim_interior", "SSIM, interior", "%.4f", true, [](const view_values& v) { return v.ssim_interior; }},
    {"psnr_8bit", "PSNR of 8 bits (dB)", "%.2f", true, [](const view_values& v) { return v.psnr_8bit; }},
    {"lpips", "LPIPS", "%.4f", false, [](const view_values& v) { return v.lpips; }},
    {"fitted_psnr", "PSNR, exposure fitted (dB)", "%.2f", false,
     [](const view_values& v) { return v.fitted_psnr; }},
    {"refined_psnr", "PSNR, camera refined (dB)", "%.2f", false,
     [](const view_values& v) { return v.refined_psnr; }},
}};

/// Returns the mean over the views that have the measure, or nothing if no view has it.
inline std::optional<double> mean(const std::vector<view_quality>& views, const view_measure& measure) {
    double sum = 0;
    std::size_t count = 0;
    for (const view_quality& view : views)
        if (const auto value = measure.of(view)) {
            sum += *value;
            ++count;
        }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

}  // namespace gs::evaluate
