// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "synthetic_passers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "synthetic_random.hpp"

namespace gs {
namespace {

using color = std::array<std::uint8_t, 4>;

color random_color(std::mt19937_64& random) {
    color made{0, 0, 0, 255};
    for (std::size_t c = 0; c < 3; ++c) made[c] = to_byte(uniform(random));
    return made;
}

/// Calls `paint(pixel, dx)` for the pixels of a disc, in which `dx` is the distance from its center
/// along a row. `share`: area of the disc as a share of the image.
template <class Paint>
void for_each_in_disc(const image& pixels, double x, double y, double share, const Paint& paint) {
    const double square = share * pixels.width * pixels.height / std::numbers::pi;
    std::size_t i = 0;
    for (int row = 0; row < pixels.height; ++row)
        for (int column = 0; column < pixels.width; ++column, ++i) {
            const double dx = column + 0.5 - x, dy = row + 0.5 - y;
            if (dx * dx + dy * dy <= square) paint(i, dx);
        }
}

void set(image& pixels, std::size_t i, const color& to) {
    std::ranges::copy(to, pixels.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
}

}  // namespace

void paint_passer(const synthetic_parameters& how, std::size_t photo, bool masks, image& pixels) {
    std::mt19937_64 random(photo + (std::uint64_t{1} << 63));
    const double x = uniform(random) * pixels.width, y = uniform(random) * pixels.height;
    const color painted = random_color(random);
    for_each_in_disc(pixels, x, y, how.passers,
                     [&](std::size_t i, double) { masks ? pixels.mask_pixel(i) : set(pixels, i, painted); });
}

void paint_moving_thing(const synthetic_parameters& how, std::size_t photo, image& pixels) {
    const auto before = [&](std::size_t n) { return std::floor(how.moving * static_cast<double>(n) + 0.5); };
    if (before(photo + 1) == before(photo)) return;
    std::mt19937_64 random(photo + (std::uint64_t{3} << 62));
    const double x = (0.25 + 0.5 * uniform(random)) * pixels.width,
                 y = (0.25 + 0.5 * uniform(random)) * pixels.height;
    const double share = 0.04 + 0.08 * uniform(random);
    const color first = random_color(random), second = random_color(random);
    const double stripe = pixels.width / 12.0;
    for_each_in_disc(pixels, x, y, share, [&](std::size_t i, double dx) {
        if (!pixels.is_masked(i))
            set(pixels, i, std::fmod(std::abs(dx), 2 * stripe) < stripe ? first : second);
    });
}

}  // namespace gs
