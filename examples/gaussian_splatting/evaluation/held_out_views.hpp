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

/// The file names of the pictures of views, without a folder: "a/b.jpg" is drawn as "a_b.png". No two are the
/// same.
std::vector<std::string> picture_names(const std::vector<view>& views);

/// The test views of a scene, each measured.
struct test_report {
    std::vector<view_quality> views;
    double psnr() const;  ///< mean over the views, as the field has it
    double ssim() const;
    std::optional<double> fitted_psnr() const;
};

/// Measures every test view that `engine` holds. Where `folder` is not empty, writes each picture to
/// `folder/renders` and its photo to `folder/gt`, by its `picture_names`. `fits`: also after fitting
/// exposures.
test_report measure_test_views(train::engine& engine, const scene& scene,
                               const std::array<float, 3>& background, const std::filesystem::path& folder,
                               bool fits = false);

}  // namespace gs::evaluate
