// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "small_view.hpp"

#include <algorithm>
#include <cmath>

#include "../scene/view_photo.hpp"

namespace gs::stereo {

small_view reduced(const view& of, int longer_side) {
    const double scale =
        std::min(1.0, static_cast<double>(longer_side) / std::max(of.camera.width, of.camera.height));
    const auto side = [&](int pixels) { return std::max(1, static_cast<int>(std::lround(pixels * scale))); };
    small_view small{of.camera.resized(side(of.camera.width), side(of.camera.height)), {}, {}, {}, {}};
    const view_photo photo(of);
    const image pixels = downsample(photo.pixels(), small.camera.width, small.camera.height);
    for (std::size_t i = 0; i < small.pixels(); ++i) {
        const std::uint8_t* p = &pixels.rgba[4 * i];
        small.color.emplace_back(p[0], p[1], p[2]);
        small.brightness.push_back(static_cast<float>(p[0] + p[1] + p[2]) / 765);
        small.is_usable.push_back(p[3] == 255 ? 1.0F : 0.0F);
        const auto x = static_cast<double>(i % small.width()), y = static_cast<double>(i / small.width());
        small.ray.emplace_back(small.camera.ray(x + 0.5, y + 0.5));
    }
    return small;
}

}  // namespace gs::stereo
