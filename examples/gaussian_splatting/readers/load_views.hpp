// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "reader.hpp"

namespace gs {

/// Loads images from their files, in parallel. The views keep the order of `records`. Scales the
/// cameras to the size of the files, removes lens distortion, applies masks, and then downsamples
/// to the resolution: see `load_options`. If the photos together exceed
/// `load_options::most_photo_bytes`, the views are streamed. Throws `error` with the name of a file
/// that cannot be used. Precondition: no record holds pixels.
std::vector<view> load_views(const std::vector<image_record>& records, const load_options& options,
                             const log_function& log);

}  // namespace gs
