// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../device_feature.hpp"
#include "residual_weights.hpp"

namespace gs::features {

template <class Renderer>
class moving_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;

  public:
    explicit moving_on_device(typename Renderer::device_type& device) : weights_(device) {}

    void begin(const train::training_setup& setup) override {
        iterations_ = setup.facts.iterations;
        is_on_ = setup.has("moving");
        begin_views(static_cast<std::size_t>(setup.facts.views));
    }
    void set_views(std::size_t training_views) override {
        is_on_ = false;
        begin_views(training_views);
    }
    /// Begins the effect, during training, too.
    void set_values(const std::vector<float>&) override {
        is_on_ = true;
        begin_views(static_cast<std::size_t>(views_));
    }
    /// Returns the largest residual that counted fully in the last step, or nothing if the effect is off.
    std::vector<float> values() const override {
        return is_on_ ? std::vector<float>{weights_.limit()} : std::vector<float>{};
    }

    void exchange(state_archive& archive) override {
        if (is_on_) weights_.exchange(archive);
    }

    std::size_t memory_key(const step& s) const override {
        if (!is_on_) return 0;
        return weighs(s.plan.iteration) ? 2 : 1;
    }
    const float* show(const step& s, const float* render) override {
        if (is_on_) weights_.measure(s.target, render, s.own_rows(), s.renderer.capacity());
        return render;
    }
    const float* backward(const step& s, const float* gradient) override {
        return is_on_ && weighs(s.plan.iteration) ? weights_.weigh(gradient) : gradient;
    }

  private:
    void begin_views(std::size_t views) {
        views_ = static_cast<int>(views);
        if (is_on_) weights_.reset(views);
    }
    /// Returns whether weights apply. Before, the model does not show yet which things are static.
    bool weighs(int iteration) const {
        return iteration > std::min(iterations_.milestone(0.1), std::max(500, 3 * views_));
    }

    residual_weights<typename Renderer::device_type> weights_;
    iteration_plan iterations_;
    int views_ = 0;
    bool is_on_ = false;
};

}  // namespace gs::features
