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

namespace {

/// A render and its photo, by pixels. Values are doubles in [0, 1].
class compared_pixels {
  public:
    compared_pixels(const std::vector<float>& render, const image& shot,
                    const std::array<float, 3>& background)
        : render_(render),
          shot_(shot),
          photo_(over_background(shot, background.data())),
          pixels_(render.size() / 3) {}

    int width() const { return shot_.width; }
    /// Returns the color of the render, and 1.
    glm::dvec4 shown(std::size_t pixel) const {
        const auto value = [&](std::size_t c) {
            return static_cast<double>(std::clamp(render_[c * pixels_ + pixel], 0.0f, 1.0f));
        };
        return {value(0), value(1), value(2), 1};
    }
    double photo(std::size_t c, std::size_t pixel) const {
        return static_cast<double>(photo_[c * pixels_ + pixel]);
    }
    /// Calls f with each pixel of these columns that is not masked.
    template <class F>
    void over(int from, int to, const F& f) const {
        for (int y = 0; y < shot_.height; ++y)
            for (int x = from; x < to; ++x) {
                const std::size_t pixel =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(shot_.width) +
                    static_cast<std::size_t>(x);
                if (!shot_.is_masked(pixel)) f(pixel);
            }
    }
    /// Returns the PSNR of the right half, with `map` applied to the render.
    std::optional<double> psnr(const std::array<glm::dvec4, 3>& map) const {
        double squares = 0, values = 0;
        over(width() / 2, width(), [&](std::size_t i) {
            const glm::dvec4 x = shown(i);
            for (std::size_t c = 0; c < 3; ++c) {
                const double d = std::clamp(glm::dot(map[c], x), 0.0, 1.0) - photo(c, i);
                squares += d * d;
            }
            values += 3;
        });
        if (values == 0) return std::nullopt;
        return -10 * std::log10(squares / values);
    }

  private:
    const std::vector<float>& render_;
    const image& shot_;
    std::vector<float> photo_;
    std::size_t pixels_;
};

}  // namespace

std::optional<double> psnr_after_fit(const std::vector<float>& render, const image& shot,
                                     const std::array<float, 3>& background) {
    const compared_pixels compared(render, shot, background);
    // Regularizes toward the identity, because the left half may have too few different colors.
    double ridge = 0;
    compared.over(0, compared.width(), [&](std::size_t) { ridge += 1e-4; });
    glm::dmat4 normal(ridge);
    std::array<glm::dvec4, 3> right{};
    for (int c = 0; c < 3; ++c) right[static_cast<std::size_t>(c)][c] = ridge;
    compared.over(0, compared.width() / 2, [&](std::size_t i) {
        const glm::dvec4 x = compared.shown(i);
        normal += glm::outerProduct(x, x);
        for (std::size_t c = 0; c < 3; ++c) right[c] += compared.photo(c, i) * x;
    });
    const glm::dmat4 inverse = glm::inverse(normal);
    std::array<glm::dvec4, 3> map{};
    for (std::size_t c = 0; c < 3; ++c) map[c] = inverse * right[c];
    return compared.psnr(map);
}

std::optional<double> psnr_of_right_half(const std::vector<float>& render, const image& shot,
                                         const std::array<float, 3>& background) {
    return compared_pixels(render, shot, background)
        .psnr({glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0)});
}

}  // namespace gs::evaluate
