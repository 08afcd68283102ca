// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "respond_in_model.hpp"

#include <algorithm>
#include <cstddef>

#include "../../model/spherical_harmonics.hpp"
#include "response_kernels.hpp"

namespace gs::features {
namespace {

/// Changes the coefficients of one color, three for each harmonic. `rest`: those of degree 1 and above.
void respond_in_color(const float* increments, float* constant, float* rest, std::size_t rest_width) {
    for (unsigned c = 0; c < 3; ++c) {
        const float* own = increments + response_at(c, 0);
        const float color = 0.5f + static_cast<float>(sh_c0) * constant[c];
        const float shown = std::clamp(color, 0.0f, 1.0f);
        const response_basis<float> basis(shown);
        const float slope = weighted(basis.slope, own);
        constant[c] = sh_from_color(weighted(basis.curve, own) + slope * (color - shown));
        for (std::size_t k = c; k < rest_width; k += 3) rest[k] *= slope;
    }
}

}  // namespace

void respond_in_model(const float* increments, gaussians& model) {
    const auto width = static_cast<std::size_t>(model.rest_width());
    for (std::size_t i = 0; i < model.count(); ++i)
        respond_in_color(increments, model.sh_constant.data() + 3 * i, model.sh_rest.data() + width * i,
                         width);
    if (!model.sky.empty())
        respond_in_color(increments, model.sky.data(), model.sky.data() + 3, sky_width - 3);
}

}  // namespace gs::features
