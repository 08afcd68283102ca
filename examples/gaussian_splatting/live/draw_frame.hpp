// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "../engine/engine.hpp"
#include "../engine/rendered_pixels.hpp"
#include "../scene/scene.hpp"
#include "mailbox.hpp"

namespace gs::live {

/// Draws frames of the model of an engine. Training is not affected: see
/// `render_options::separate_memory`.
class frame_artist {
  public:
    /// Changes the render of a training view so that it matches its photo, as the exposure does.
    using show_function =
        std::function<void(std::size_t view, const train::rendered_pixels&, std::vector<float>& render)>;

    /// `views`: the training views, or none. `show` returns the function for the present model.
    /// `engine` and `views` must outlive the object.
    frame_artist(
        train::engine& engine, const std::vector<view>& views, const std::array<float, 3>& background,
        std::function<show_function()> show = [] { return show_function{}; })
        : engine_(engine), views_(views), background_(background), show_(std::move(show)) {}

    /// Draws a frame. Errors compare the render of a view with its photo, which is scaled to the
    /// size of the frame; masked pixels have no error. Throws `error` if the frame cannot be drawn.
    picture draw(const view_request& request);

  private:
    struct scaled_photo {
        std::size_t view;
        image pixels;
    };

    camera camera_for(const view_request& request) const;
    const image& photo_of(std::size_t view, int width, int height);
    std::vector<float> error_of(std::size_t view, const camera& camera, std::vector<float> render);

    train::engine& engine_;
    const std::vector<view>& views_;
    std::array<float, 3> background_;
    std::function<show_function()> show_;
    std::optional<scaled_photo> photo_;  ///< of the last view whose error was drawn
};

}  // namespace gs::live
