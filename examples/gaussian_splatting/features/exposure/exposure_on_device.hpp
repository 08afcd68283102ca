// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "../device_feature.hpp"
#include "exposures.hpp"

namespace gs::features {

template <class Renderer>
class exposure_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;

  public:
    explicit exposure_on_device(typename Renderer::device_type& device)
        : of_training_(device), of_held_out_(device) {}

    void begin(const train::training_setup& setup) override {
        iterations_ = setup.facts.iterations;
        views_ = static_cast<std::size_t>(setup.facts.views);
        learns_ = setup.has("exposure");
        reset();
    }
    void set_views(std::size_t training_views) override {
        learns_ = false;
        views_ = training_views;
        reset();
    }

    void set_values(const std::vector<float>& values) override { of_training_.set(values); }
    std::vector<float> values() const override { return of_training_.get(); }
    void set_held_out_values(const std::vector<float>& values) override { of_held_out_.set(values); }
    void normalize() override { of_training_.normalize(); }

    void exchange(state_archive& archive) override {
        if (learns_) of_training_.exchange(archive);
    }

    std::size_t memory_key(const step&) const override { return learns_ ? 1 : 0; }
    const float* show(const step& s, const float* render) override {
        if (!learns_) return render;
        input_ = render;
        return of_training_.show(s.plan.view, render, s.pixels());
    }
    const float* backward(const step& s, const float* gradient) override {
        if (!learns_) return gradient;
        const image_part part{s.camera.width, s.camera.height, s.own_rows()};
        return of_training_.learn(s.plan.view, input_, gradient, part, rate_at(s.plan.iteration),
                                  s.renderer.capacity());
    }
    const float* show_held_out(std::size_t view, const float* render, std::size_t pixels) override {
        return of_held_out_.count() > 0 ? of_held_out_.show(view, render, pixels) : render;
    }

  private:
    void reset() {
        of_training_.set(flattened(std::vector<exposure>(views_, identity_exposure)));
        of_held_out_.set({});
    }
    /// Returns Adam's learning rate, which decays to a tenth. It is higher if fewer steps use each
    /// view, so that exposures can change by 0.6 if at least 30 steps use a view. Kerbl et al. 2024
    /// begin at 0.01.
    float rate_at(int iteration) const {
        const double first =
            std::min(0.05, 1.5 * static_cast<double>(views_) / static_cast<double>(iterations_.last()));
        return static_cast<float>(first * std::pow(0.1, iterations_.progress(iteration)));
    }

    exposures<typename Renderer::device_type> of_training_, of_held_out_;
    const float* input_ = nullptr;  ///< of `show` in this step
    iteration_plan iterations_;
    std::size_t views_ = 0;
    bool learns_ = false;
};

}  // namespace gs::features
