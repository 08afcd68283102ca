// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "gltf_layout.hpp"

#include "../axes.hpp"

namespace gs {

std::vector<gltf_attribute> gltf_attributes(int sh_degree, int model_degree) {
    const std::string prefix = std::string(gltf_extension) + ":";
    constexpr std::array<float, 4> same{1, 1, 1, 1};
    const auto& p = turn_about_x::position;
    const auto& q = turn_about_x::rotation;
    using enum gltf_encoding;
    std::vector<gltf_attribute> all{
        {"POSITION", "VEC3", &gaussians::mean, 3, 0, 3, plain, {p[0], p[1], p[2], 1}},
        {prefix + "ROTATION", "VEC4", &gaussians::quaternion, 4, 0, 4, rotation, {q[1], q[2], q[3], q[0]}},
        {prefix + "SCALE", "VEC3", &gaussians::log_scale, 3, 0, 3, exponential, same},
        {prefix + "OPACITY", "SCALAR", &gaussians::opacity, 1, 0, 1, sigmoid, same},
        {prefix + "SH_DEGREE_0_COEF_0", "VEC3", &gaussians::sh_constant, 3, 0, 3, plain, same}};
    const auto model_width = static_cast<std::size_t>(3 * (sh_coefficients(model_degree) - 1));
    std::size_t coefficient = 0;
    for (int degree = 1; degree <= sh_degree; ++degree)
        for (int k = 0; k < 2 * degree + 1; ++k, ++coefficient) {
            const float sign = turn_about_x::sh[coefficient];
            all.push_back({prefix + "SH_DEGREE_" + std::to_string(degree) + "_COEF_" + std::to_string(k),
                           "VEC3",
                           &gaussians::sh_rest,
                           3,
                           3 * coefficient,
                           model_width,
                           plain,
                           {sign, sign, sign, 1}});
        }
    return all;
}

}  // namespace gs
