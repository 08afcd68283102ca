// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "draw_frame.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../core/error.hpp"
#include "../scene/view_photo.hpp"

namespace gs::live {
namespace {

using color = std::array<float, 3>;

/// Returns a color for a level from 0 to 1: black, purple, orange, white. Lightness grows with it.
color heat(float level) {
    constexpr std::array<color, 5> stops{{{0, 0, 0.02f},
                                          {0.34f, 0.06f, 0.43f},
                                          {0.73f, 0.21f, 0.33f},
                                          {0.98f, 0.55f, 0.04f},
                                          {0.99f, 1, 0.64f}}};
    constexpr int last = static_cast<int>(stops.size()) - 1;
    const float at = std::clamp(level, 0.0f, 1.0f) * static_cast<float>(last);
    const int below = std::min(static_cast<int>(at), last - 1);
    const float share = at - static_cast<float>(below);
    color mixed{};
    for (std::size_t c = 0; c < 3; ++c)
        mixed[c] = std::lerp(stops[static_cast<std::size_t>(below)][c],
                             stops[static_cast<std::size_t>(below) + 1][c], share);
    return mixed;
}

/// Shows levels as heat, of which `most` is the brightest.
picture in_heat(int width, int height, const std::vector<float>& levels, float most) {
    picture p{width, height, {}};
    p.rgb.reserve(3 * levels.size());
    for (const float level : levels)
        for (const float channel : heat(level / most)) p.rgb.push_back(to_byte(channel));
    return p;
}

/// Returns a value that only one in a hundred exceeds, or 1 if there are no positive values.
float nearly_largest(std::vector<float> values) {
    const auto rank = values.begin() + static_cast<std::ptrdiff_t>(values.size() - 1 - values.size() / 100);
    std::nth_element(values.begin(), rank, values.end());
    return *rank > 0 ? *rank : 1.0f;
}

}  // namespace

camera frame_artist::camera_for(const view_request& request) const {
    if (!request.view) return camera_of(request);
    const camera own = engine_.cameras().training_camera(*request.view, views_.at(*request.view).camera);
    const double scale =
        std::min({1.0, request.width / double(own.width), request.height / double(own.height)});
    const auto scaled = [=](int side) { return std::max(1, static_cast<int>(std::lround(scale * side))); };
    return own.resized(scaled(own.width), scaled(own.height));
}

const image& frame_artist::photo_of(std::size_t view, int width, int height) {
    if (!photo_ || photo_->view != view || photo_->pixels.width != width || photo_->pixels.height != height)
        photo_ = {view, downsample(view_photo(views_[view]).pixels(), width, height)};
    return photo_->pixels;
}

std::vector<float> frame_artist::error_of(std::size_t view, const camera& camera, std::vector<float> render) {
    if (const show_function show = show_(); show) show(view, {camera.width, camera.height}, render);
    const image& photo = photo_of(view, camera.width, camera.height);
    const std::vector<float> target = over_background(photo, background_.data());
    const std::size_t pixels = target.size() / 3;
    std::vector<float> errors(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        if (photo.is_masked(i)) continue;
        for (std::size_t c = 0; c < 3; ++c)
            errors[i] +=
                std::abs(std::clamp(render[c * pixels + i], 0.0f, 1.0f) - target[c * pixels + i]) / 3;
    }
    return errors;
}

picture frame_artist::draw(const view_request& request) {
    const camera camera = camera_for(request);
    const bool shows_depth = request.overlay == overlay::depth;
    std::vector<float> render =
        engine_.render(camera, background_, {.inverse_depth = shows_depth, .separate_memory = true});
    if (request.overlay == overlay::none) return {camera.width, camera.height, interleaved(render)};
    if (shows_depth) return in_heat(camera.width, camera.height, render, nearly_largest(render));
    constexpr float brightest_error = 0.25f;
    return in_heat(camera.width, camera.height, error_of(*request.view, camera, std::move(render)),
                   brightest_error);
}

}  // namespace gs::live
