// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../image/image.hpp"

namespace gs::pages {

/// A rectangle over a photo, or a ring around its corner if both sides are zero. In pixels.
struct mark {
    double left, top;
    double width = 0, height = 0;
    int color = 0;  ///< 0 or 1
};

/// A photo for a page, with marks.
struct marked_photo {
    std::string label;   ///< such as "Brightest photo"
    std::string name{};  ///< of the photo, or empty
    std::string note{};  ///< a sentence about the marks or the photo, or empty
    image pixels;        ///< opaque: see `thumbnail`
    int width, height;   ///< size of the photo that the marks refer to
    std::vector<mark> marks{};
};

}  // namespace gs::pages
