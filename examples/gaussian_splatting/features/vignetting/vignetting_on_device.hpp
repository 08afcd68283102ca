// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../device_feature.hpp"
#include "falloff_values.hpp"
#include "falloffs.hpp"

namespace gs::features {

/// Learns the falloff of each lens from the gradients of all its photos. See `falloff_values` for the values,
/// and `held_out_falloff` for those of held-out views.
template <class Renderer>
class vignetting_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;

  public:
    explicit vignetting_on_device(typename Renderer::device_type& device)
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
        const falloff_values given(values, views_);
        lens_of_ = given.lens_of_view;
        of_training_.set(given.parameters);
    }
    std::vector<float> values() const override {
        return falloff_values{lens_of_, of_training_.get()}.flattened();
    }
    void set_held_out_values(const std::vector<float>& values) override {
        held_out_ = held_out_falloffs(values);
        std::vector<float> parameters;
        for (const held_out_falloff& f : held_out_)
            parameters.insert(parameters.end(), f.parameters.begin(), f.parameters.end());
        of_held_out_.set(parameters);
    }

    void exchange(state_archive& archive) override {
        if (!lens_of_.empty()) of_training_.exchange(archive);
    }

    std::size_t memory_key(const step& s) const override { return has_falloff(s) ? 1 : 0; }
    const float* show(const step& s, const float* render) override {
        if (!has_falloff(s)) return render;
        input_ = render;
        return of_training_.show(lens_of(s), render, geometry_of(s.camera));
    }
    const float* backward(const step& s, const float* gradient) override {
        if (!has_falloff(s)) return gradient;
        return of_training_.learn(lens_of(s), input_, gradient, geometry_of(s.camera), s.own_rows(),
                                  rate_at(s.plan.iteration), s.renderer.capacity());
    }
    const float* show_held_out(std::size_t view, const float* render, std::size_t) override {
        if (view >= held_out_.size() || held_out_[view].geometry.width == 0) return render;
        return of_held_out_.show(view, render, held_out_[view].geometry);
    }

  private:
    void reset() {
        lens_of_.clear();
        held_out_.clear();
        of_training_.set({});
        of_held_out_.set({});
    }
    bool has_falloff(const step& s) const { return !lens_of_.empty() && lens_of_[s.plan.view] >= 0; }
    std::size_t lens_of(const step& s) const { return static_cast<std::size_t>(lens_of_[s.plan.view]); }

    /// Returns Adam's learning rate, which decays to a tenth. It is zero before the model shows how bright
    /// the scene is. A few hundred steps of a lens suffice for the strongest falloff.
    float rate_at(int iteration) const {
        if (iteration <= std::min(iterations_.milestone(0.1), 500)) return 0;
        const double lenses = static_cast<double>(of_training_.count());
        const double first =
            std::min(0.01, 20 * lenses / static_cast<double>(std::max(iterations_.last(), 1)));
        return static_cast<float>(first * std::pow(0.1, iterations_.progress(iteration)));
    }

    falloffs<typename Renderer::device_type> of_training_, of_held_out_;
    std::vector<int> lens_of_;  ///< by training view: see `falloff_values`; empty if the effect is off
    std::vector<held_out_falloff> held_out_;
    const float* input_ = nullptr;  ///< of `show` in this step
    iteration_plan iterations_;
    std::size_t views_ = 0;
};

}  // namespace gs::features
