// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../train/engine.hpp"

namespace gs::evaluate {

struct view_quality {
    std::string name;
    train::quality quality;
};

/// The file names of the pictures of views, without a folder: "a/b.jpg" is drawn as "a_b.png". No two are the
/// same.
std::vector<std::string> picture_names(const std::vector<view>& views);

/// The test views of a scene, each measured.
struct test_report {
    std::vector<view_quality> views;
    double psnr() const;  ///< mean over the views, as the field has it
    double ssim() const;
};

/// Measures every test view that `engine` holds. Where `folder` is not empty, writes each picture to
/// `folder/renders` and its photo to `folder/gt`, by its `picture_names`.
test_report measure_test_views(train::engine& engine, const scene& scene,
                               const std::array<float, 3>& background, const std::filesystem::path& folder);

}  // namespace gs::evaluate
