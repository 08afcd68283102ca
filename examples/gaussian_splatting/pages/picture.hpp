// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../image/image.hpp"

namespace gs::pages {

/// Returns an opaque image of three planes with values in [0, 1].
image image_of(int width, int height, const std::vector<float>& planes);

/// Returns the mean absolute difference of the channels as colors: black for equal pixels, through
/// red, to bright yellow for a difference of a quarter or more. Throws `error` with `name` if the
/// sizes differ.
image error_image(const image& a, const image& b, const std::string& name);

/// Returns a photo for a page: opaque, and at most 640 pixels on its longer side. Transparent parts
/// show a checkerboard, and masked pixels stripes.
image thumbnail(const image& photo);

/// Returns the image as a JPEG in a data URL. Downsamples it to at most 960 pixels on its longer
/// side.
std::string data_url(const image& pixels);

}  // namespace gs::pages
