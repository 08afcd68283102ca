// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "../../scene/image_radius.hpp"
#include "lens_values.hpp"
#include "vignetting_kernels.hpp"

namespace gs::features {

/// The values of the effect `vignetting`.
using falloff_values = lens_values<falloff_width>;

/// Returns the geometry of a camera's images.
inline falloff_geometry geometry_of(const camera& c) {
    return {c.width, c.height, static_cast<float>(c.cx), static_cast<float>(c.cy),
            static_cast<float>(1 / square_of_farthest_corner(c))};
}

/// The falloff of a held-out view. A width of zero means none.
struct held_out_falloff {
    falloff_geometry geometry{};
    std::array<float, falloff_width> parameters{};
};

/// Converts falloffs of held-out views to numbers, or back.
/// @{
inline std::vector<float> flattened(const std::vector<held_out_falloff>& all) {
    std::vector<float> values;
    for (const auto& [g, parameters] : all) {
        values.insert(values.end(), {static_cast<float>(g.width), static_cast<float>(g.height), g.cx, g.cy,
                                     g.inverse_square});
        values.insert(values.end(), parameters.begin(), parameters.end());
    }
    return values;
}
inline std::vector<held_out_falloff> held_out_falloffs(const std::vector<float>& values) {
    constexpr std::size_t width = 5 + falloff_width;
    std::vector<held_out_falloff> all(values.size() / width);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const float* v = values.data() + i * width;
        all[i].geometry = {static_cast<int>(v[0]), static_cast<int>(v[1]), v[2], v[3], v[4]};
        for (std::size_t k = 0; k < falloff_width; ++k) all[i].parameters[k] = v[5 + k];
    }
    return all;
}
/// @}

}  // namespace gs::features
