// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "../../core/log.hpp"
#include "../../pages/viewer_page.hpp"
#include "../../scene/scene.hpp"
#include "../writer.hpp"

namespace gs {

/// Web pages that show the model: see `pages::write_viewer_page`. They contain it as a compressed
/// PLY file, whose precision `compressed_ply_writer` describes. They can only be written. Without
/// training views, the first view shows the middle half of the Gaussians from the side.
extern const writer html_writer;

/// Returns the training views for the viewer, at most 200 of them. Precondition: `scene` has
/// training views and is normalized.
pages::viewer_scene viewer_scene_of(const scene& scene, std::string title,
                                    const std::array<float, 3>& background);

/// Writes the page for a model in world coordinates. If it would be larger than `most_bytes`, it
/// shows only the most important Gaussians: those of the largest opacity times area. Passes a
/// message about that to `log`.
void write_viewer(const std::filesystem::path& file, const gaussians& model, pages::viewer_scene scene,
                  std::uint64_t most_bytes, const log_function& log, const write_options& options = {});

}  // namespace gs
