// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../device_feature.hpp"
#include "../vignetting/lens_values.hpp"
#include "responses.hpp"

namespace gs::features {

/// The values of the effect `response`.
using response_values = lens_values<response_width>;

/// Learns the response of each lens's camera from the gradients of all its photos. Values of training views:
/// see `response_values`. Values of held-out views: `response_width` for each, or zeros for none.
template <class Renderer>
class response_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;

  public:
    explicit response_on_device(typename Renderer::device_type& device)
        : of_training_(device), of_held_out_(device) {}

    void begin(const train::training_setup& setup) override {
        iterations_ = setup.facts.iterations;
        views_ = static_cast<std::size_t>(setup.facts.views);
        reset();
    }
    void set_views(std::size_t training_views) override {
        views_ = training_views;
        reset();
    }

    void set_values(const std::vector<float>& values) override {
        const response_values given(values, views_);
        lens_of_ = given.lens_of_view;
        of_training_.set(given.parameters);
    }
    std::vector<float> values() const override {
        return response_values{lens_of_, of_training_.get()}.flattened();
    }
    void set_held_out_values(const std::vector<float>& values) override {
        has_held_out_.clear();
        for (std::size_t i = 0; i < values.size(); i += response_width)
            has_held_out_.push_back(values[i] > 0);
        of_held_out_.set(values);
    }

    void exchange(state_archive& archive) override {
        if (!lens_of_.empty()) of_training_.exchange(archive);
    }

    std::size_t memory_key(const step& s) const override { return has_response(s) ? 1 : 0; }
    const float* show(const step& s, const float* render) override {
        if (!has_response(s)) return render;
        input_ = render;
        return of_training_.show(lens_of(s), render, s.pixels());
    }
    const float* backward(const step& s, const float* gradient) override {
        if (!has_response(s)) return gradient;
        const image_part part{s.camera.width, s.camera.height, s.own_rows()};
        return of_training_.learn(lens_of(s), input_, gradient, part, rate_at(s.plan.iteration),
                                  s.renderer.capacity());
    }
    const float* show_held_out(std::size_t view, const float* render, std::size_t pixels) override {
        if (view >= has_held_out_.size() || !has_held_out_[view]) return render;
        return of_held_out_.show(view, render, pixels);
    }

  private:
    void reset() {
        lens_of_.clear();
        has_held_out_.clear();
        of_training_.set({});
        of_held_out_.set({});
    }
    bool has_response(const step& s) const { return !lens_of_.empty() && lens_of_[s.plan.view] >= 0; }
    std::size_t lens_of(const step& s) const { return static_cast<std::size_t>(lens_of_[s.plan.view]); }

    /// Returns Adam's learning rate, which decays to a tenth. It is zero before the model shows how bright
    /// the scene is. Increments are around 0.2, so a few hundred steps of a lens suffice for a strong curve.
    float rate_at(int iteration) const {
        if (iteration <= std::min(iterations_.milestone(0.1), 500)) return 0;
        const double lenses = static_cast<double>(of_training_.count());
        const double first =
            std::min(0.005, 5 * lenses / static_cast<double>(std::max(iterations_.last(), 1)));
        return static_cast<float>(first * std::pow(0.1, iterations_.progress(iteration)));
    }

    responses<typename Renderer::device_type> of_training_, of_held_out_;
    std::vector<int> lens_of_;  ///< by training view: see `lens_values`; empty if the effect is off
    std::vector<bool> has_held_out_;
    const float* input_ = nullptr;  ///< of `show` in this step
    iteration_plan iterations_;
    std::size_t views_ = 0;
};

}  // namespace gs::features
