// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../engine/engine.hpp"
#include "../ranks/communicator.hpp"
#include "lpips/lpips.hpp"
#include "view_measures.hpp"

namespace gs::evaluate {

/// Returns the file names, without a folder, for renders of views: "a/b.jpg" becomes "a_b.png". No
/// two names are equal.
std::vector<std::string> render_names(const std::vector<view>& views);

/// The measurements of a scene's held-out views.
struct held_out_report {
    std::vector<view_quality> views;
    std::optional<int> lpips_black;  ///< see `lpips_network::black`; unset if LPIPS is not computed

    /// Means of the views' values, PSNR in dB; NaN without views.
    /// @{
    double psnr() const;
    double ssim() const;
    /// @}
    std::optional<double> mean_of(std::string_view key) const;  ///< mean of a `view_measure`
};

/// What `measure_held_out_views` does besides measuring PSNR and SSIM.
struct held_out_options {
    std::filesystem::path folder{};          ///< for renders and photos; writes none if empty
    bool fits_exposure = false;              ///< computes `fitted_psnr`
    bool refines_poses = false;              ///< computes `refined_psnr`
    const lpips_network* network = nullptr;  ///< computes LPIPS if set
    /// The processes that measure together, or null for one. All must call `measure_held_out_views`
    /// with the same model and views.
    ranks::communicator* ranks = nullptr;
};

/// Measures every held-out view of `scene`, which `engine` must hold. If `options.folder` is set,
/// writes each render to `renders` in that folder and its photo to `gt`: see `render_names`.
///
/// With several ranks, each one measures and writes a share of the views. All get the whole report, when
/// all files are written. No rank writes files before the first one has called this function.
///
/// Masked pixels do not count. LPIPS, which compares neighborhoods, shows the background there in
/// both images.
held_out_report measure_held_out_views(train::engine& engine, const scene& scene,
                                       const std::array<float, 3>& background,
                                       const held_out_options& options = {});

}  // namespace gs::evaluate
