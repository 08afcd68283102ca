// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "../device_feature.hpp"
#include "sky.hpp"

namespace gs::features {

template <class Renderer>
class sky_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;

  public:
    explicit sky_on_device(typename Renderer::device_type& device) : sky_(device) {}

    void begin(const train::training_setup& setup) override { iterations_ = setup.facts.iterations; }
    void set_model(const gaussians& model) override { sky_.set(model.sky); }
    void get_model(gaussians& model) override { model.sky = sky_.get(); }

    void exchange(state_archive& archive) override { sky_.exchange(archive); }

    std::size_t memory_key(const step&) const override { return sky_.exists() ? 1 : 0; }
    const float* background(const camera& camera) override { return sky_.draw(camera); }
    void learn(const step& s, const float* render_gradient) override {
        if (sky_.exists())
            sky_.learn(s.camera, s.transmittance, render_gradient, rate_at(s.plan.iteration),
                       s.renderer.capacity(), s.own_rows());
    }

  private:
    /// Returns Adam's learning rate of the coefficients, which decays to a hundredth.
    float rate_at(int iteration) const {
        return static_cast<float>(0.01 * std::pow(0.01, iterations_.progress(iteration)));
    }

    sky<typename Renderer::device_type> sky_;
    iteration_plan iterations_;
};

}  // namespace gs::features
