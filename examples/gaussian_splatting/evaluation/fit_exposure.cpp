// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "fit_exposure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace gs::evaluate {

std::optional<double> psnr_after_fit(const std::vector<float>& render, const image& shot,
                                     const std::array<float, 3>& background) {
    const int width = shot.width, height = shot.height;
    const std::vector<float> photo = over_background(shot, background.data());
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto shown = [&](std::size_t pixel) {
        const auto value = [&](std::size_t c) {
            return static_cast<double>(std::clamp(render[c * pixels + pixel], 0.0f, 1.0f));
        };
        return glm::dvec4(value(0), value(1), value(2), 1);
    };
    const auto over = [&](int from, int to, const auto& f) {
        for (int y = 0; y < height; ++y)
            for (int x = from; x < to; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(x);
                if (!shot.is_masked(pixel)) f(pixel);
            }
    };
    // Regularizes toward the identity, because the left half may have too few different colors.
    double ridge = 0;
    over(0, width, [&](std::size_t) { ridge += 1e-4; });
    glm::dmat4 normal(ridge);
    std::array<glm::dvec4, 3> right{};
    for (int c = 0; c < 3; ++c) right[static_cast<std::size_t>(c)][c] = ridge;
    over(0, width / 2, [&](std::size_t i) {
        const glm::dvec4 x = shown(i);
        normal += glm::outerProduct(x, x);
        for (std::size_t c = 0; c < 3; ++c) right[c] += static_cast<double>(photo[c * pixels + i]) * x;
    });
    const glm::dmat4 inverse = glm::inverse(normal);
    std::array<glm::dvec4, 3> map{};
    for (std::size_t c = 0; c < 3; ++c) map[c] = inverse * right[c];

    double squares = 0, values = 0;
    over(width / 2, width, [&](std::size_t i) {
        const glm::dvec4 x = shown(i);
        for (std::size_t c = 0; c < 3; ++c) {
            const double d =
                std::clamp(glm::dot(map[c], x), 0.0, 1.0) - static_cast<double>(photo[c * pixels + i]);
            squares += d * d;
        }
        values += 3;
    });
    if (values == 0) return std::nullopt;
    return -10 * std::log10(squares / values);
}

}  // namespace gs::evaluate
