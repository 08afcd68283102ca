// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "../engine/engine.hpp"

namespace gs::evaluate {

struct view_quality {
    std::string name;
    train::image_quality quality;
    std::optional<double> fitted_psnr;  ///< see fit_exposure.hpp
};

/// Returns the file names, without a folder, for renders of views: "a/b.jpg" becomes "a_b.png". No
/// two names are equal.
std::vector<std::string> render_names(const std::vector<view>& views);

/// The measurements of a scene's held-out views.
struct held_out_report {
    std::vector<view_quality> views;
    double psnr() const;  ///< mean of the views' values, in dB
    double ssim() const;
    std::optional<double> fitted_psnr() const;
};

/// Measures every held-out view of `scene`, which `engine` must hold. Unless `folder` is empty,
/// writes each render to `folder/renders` and its photo to `folder/gt`: see `render_names`. If
/// `fits` is set, also reports the PSNR after fitting exposures.
held_out_report measure_held_out_views(train::engine& engine, const scene& scene,
                                       const std::array<float, 3>& background,
                                       const std::filesystem::path& folder, bool fits = false);

}  // namespace gs::evaluate
