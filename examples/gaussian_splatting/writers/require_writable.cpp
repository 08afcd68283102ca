// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "require_writable.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "../core/error.hpp"
#include "../core/parallel.hpp"

namespace gs {
namespace {

/// Throws `error` if one of the first `checked` of each `width` values is not finite.
void require_finite(const std::filesystem::path& file, const std::vector<float>& values, std::size_t width,
                    std::size_t checked, const char* what) {
    for_each_index_in_parallel(values.size() / width, [&](std::size_t i) {
        for (std::size_t k = 0; k < checked; ++k)
            if (!std::isfinite(values[i * width + k]))
                throw error("cannot write " + file.string() + ": the " + what + " of Gaussian " +
                            std::to_string(i) + " is not finite");
    });
}

}  // namespace

void require_writable(const std::filesystem::path& file, const gaussians& model, int sh_degree) {
    require_finite(file, model.mean, 3, 3, "position");
    require_finite(file, model.log_scale, 3, 3, "scale");
    require_finite(file, model.quaternion, 4, 4, "rotation");
    require_finite(file, model.opacity, 1, 1, "opacity");
    require_finite(file, model.sh_constant, 3, 3, "color");
    if (sh_degree > 0)
        require_finite(file, model.sh_rest, static_cast<std::size_t>(model.rest_width()),
                       static_cast<std::size_t>(3 * (sh_coefficients(sh_degree) - 1)),
                       "view-dependent color");
    for_each_index_in_parallel(model.count(), [&](std::size_t i) {
        if (std::all_of(&model.quaternion[4 * i], &model.quaternion[4 * i] + 4,
                        [](float x) { return x == 0; }))
            throw error("cannot write " + file.string() + ": the rotation of Gaussian " + std::to_string(i) +
                        " is zero");
    });
}

gaussians sized_model(std::size_t count, int sh_degree) {
    gaussians model;
    model.sh_degree = sh_degree;
    assign_zeros(model.mean, 3 * count);
    assign_zeros(model.log_scale, 3 * count);
    assign_zeros(model.quaternion, 4 * count);
    assign_zeros(model.opacity, count);
    assign_zeros(model.sh_constant, 3 * count);
    assign_zeros(model.sh_rest, count * static_cast<std::size_t>(model.rest_width()));
    return model;
}

}  // namespace gs
