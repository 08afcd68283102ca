// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"
#include "base64.hpp"

namespace gs::pages {
namespace {

constexpr int longest_side = 960, longest_side_of_thumbnail = 640, jpeg_quality = 88;
constexpr double brightest_error = 0.25;

using color = std::array<double, 3>;
constexpr std::array<color, 5> error_colors{
    {{0, 0, 4}, {87, 16, 110}, {188, 55, 84}, {249, 142, 9}, {252, 255, 164}}};
constexpr std::array<std::array<std::uint8_t, 3>, 2> stripe_colors{{{60, 0, 50}, {255, 0, 200}}};

std::uint8_t error_channel(double error, std::size_t channel) {
    constexpr std::size_t steps = error_colors.size() - 1;
    const double at = steps * std::clamp(error / brightest_error, 0.0, 1.0);
    const auto low = std::min(static_cast<std::size_t>(at), steps - 1);
    const double t = at - static_cast<double>(low);
    const double value = (1 - t) * error_colors[low][channel] + t * error_colors[low + 1][channel];
    return static_cast<std::uint8_t>(std::lround(value));
}

image opaque_image(int width, int height) {
    image made{width, height, {}};
    made.rgba.assign(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                     255);
    return made;
}

image small(const image& pixels, int longest) {
    const int longer = std::max(pixels.width, pixels.height);
    if (longer <= longest) return pixels;
    const auto side = [&](int length) {
        return std::max(1, static_cast<int>(std::lround(double(length) * longest / longer)));
    };
    return downsample(pixels, side(pixels.width), side(pixels.height));
}

}  // namespace

image image_of(int width, int height, const std::vector<float>& planes) {
    image made = opaque_image(width, height);
    const std::size_t pixels = planes.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c) made.rgba[4 * i + c] = to_byte(planes[c * pixels + i]);
    return made;
}

image error_image(const image& a, const image& b, const std::string& name) {
    if (a.width != b.width || a.height != b.height)
        throw error("the images of the view " + sanitize_for_message(name) + " differ in size");
    image made = opaque_image(a.width, a.height);
    for (std::size_t i = 0; i < made.rgba.size(); i += 4) {
        int sum = 0;
        for (std::size_t c = 0; c < 3; ++c) sum += std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]});
        for (std::size_t c = 0; c < 3; ++c) made.rgba[i + c] = error_channel(sum / (3 * 255.0), c);
    }
    return made;
}

image thumbnail(const image& photo) {
    image shown = small(photo, longest_side_of_thumbnail);
    const int pattern = std::max(2, std::max(shown.width, shown.height) / 64);
    for (int y = 0; y < shown.height; ++y)
        for (int x = 0; x < shown.width; ++x) {
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(shown.width) +
                           static_cast<std::size_t>(x);
            std::uint8_t* const rgba = &shown.rgba[4 * i];
            if (shown.is_masked(i)) {
                std::ranges::copy(stripe_colors[static_cast<std::size_t>((x + y) / pattern % 2)], rgba);
            } else {
                const int checker = (x / pattern + y / pattern) % 2 == 0 ? 150 : 210;
                for (std::size_t c = 0; c < 3; ++c)
                    rgba[c] = static_cast<std::uint8_t>(
                        std::min(255, rgba[c] + (255 - int{rgba[3]}) * checker / 255));
            }
        }
    for (std::size_t i = 3; i < shown.rgba.size(); i += 4) shown.rgba[i] = 255;
    shown.has_alpha = shown.has_mask = false;
    return shown;
}

std::string data_url(const image& pixels) {
    const image shown = small(pixels, longest_side);
    std::vector<std::uint8_t> rgb(shown.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgb.size() / 3; ++i)
        std::copy_n(shown.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 3,
                    rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
    return "data:image/jpeg;base64," + base64(encode_jpeg(shown.width, shown.height, rgb, jpeg_quality));
}

}  // namespace gs::pages
