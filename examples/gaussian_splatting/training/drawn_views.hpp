// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "../densify/score_views.hpp"
#include "../device/device.hpp"
#include "../render/gradients/accumulator.hpp"
#include "device_views.hpp"

namespace gs::train {

/// Renders the training views of one size for scores. These renders are not timed or counted as steps. Each
/// rank renders a strip.
template <class Renderer>
class drawn_views final : public score_views {
    using device = typename Renderer::device_type;
    using photo = typename device_views<device>::photo;

  public:
    /// `draw`: renders this rank's strip of a training view, which has this photo. `shares`: the Gaussians of
    /// each rank, if there are several.
    drawn_views(device& on, Renderer& renderer, device_views<device>& all, const std::vector<photo>& views,
                accumulator gradient, const std::optional<ranks::shares>& shares,
                std::function<void(std::size_t view, const photo& shot)> draw)
        : device_(on),
          renderer_(renderer),
          all_(all),
          views_(views),
          gradient_(gradient),
          shares_(shares),
          draw_(std::move(draw)) {}

    std::size_t count() const override { return views_.size(); }
    drawn_view draw(std::size_t view) override {
        draw_(view, views_[view]);
        return {all_.load_in_order(views_, view).target({}), renderer_.render(), renderer_.splats(),
                renderer_.tiles_of()};
    }
    const float* sum_scores(const float* scores) override {
        device_.pause_times(true);
        const float* sums = renderer_.pixel_sums(scores, 1, gradient_);
        device_.pause_times(false);
        return sums;
    }
    void gather(const ranks::shared_array& array) override {
        const ranks::traffic_counter::scope scope(device_.ranks().traffic(), ranks::purpose::scores);
        if (shares_) device_.gather(*shares_, {&array, 1});
    }

  private:
    device& device_;
    Renderer& renderer_;
    device_views<device>& all_;
    const std::vector<photo>& views_;
    accumulator gradient_;
    const std::optional<ranks::shares>& shares_;
    std::function<void(std::size_t view, const photo& shot)> draw_;
};

}  // namespace gs::train
