// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "../engine/engine.hpp"
#include "../features/resolve.hpp"
#include "../pages/run_record.hpp"
#include "../ranks/communicator.hpp"

namespace gs::cli {

/// The held-out views of a finished run, and the files of their images.
struct held_out_images {
    std::vector<std::string> names;  ///< of views
    std::vector<double> psnr;        ///< in dB; NaN if unknown
    std::vector<std::string> files;  ///< names in both folders
    std::filesystem::path photos, renders;

    std::filesystem::path photo(std::size_t view) const { return photos / files[view]; }
    std::filesystem::path render(std::size_t view) const { return renders / files[view]; }
};

/// Returns the held-out views that metrics.json of a run in `folder` lists.
held_out_images held_out_images_of(const std::filesystem::path& folder,
                                   const nlohmann::ordered_json& metrics);

/// Returns the worst, the median and the best held-out view. Throws `error` if an image cannot be
/// read.
std::vector<pages::view_images> typical_held_out_views(const held_out_images& views);

/// Returns the worst, the median and the best of at most 12 training views of `scene`, which
/// `engine` must hold. Renders each of these views. The ranks share this work. All must call this
/// function, and only the first one gets views.
std::vector<pages::view_images> typical_training_views(train::engine& engine, const scene& scene,
                                                       const features::feature_set& features,
                                                       const std::array<float, 3>& background,
                                                       ranks::communicator& ranks);

/// Returns the name of the file or folder at a path, such as ".", without the folders above it.
std::string last_part(const std::filesystem::path& relative);

}  // namespace gs::cli
