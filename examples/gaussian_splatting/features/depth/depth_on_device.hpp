// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "../../losses/inverse_depth/depth_gradient.hpp"
#include "../device_feature.hpp"

namespace gs::features {

template <class Renderer>
class depth_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;
    template <class T>
    using buffer = typename Renderer::template buffer<T>;

  public:
    explicit depth_on_device(typename Renderer::device_type& device) : device_(device) {}

    void begin(const train::training_setup& setup) override {
        iterations_ = setup.facts.iterations;
        if (!setup.has("depth")) fits_.clear();
    }
    void set_views(std::size_t) override { fits_.clear(); }

    void set_values(const std::vector<float>& values) override {
        fits_.clear();
        for (std::size_t i = 0; i + 1 < values.size(); i += 2) fits_.push_back({values[i], values[i + 1]});
    }
    std::vector<float> values() const override {
        std::vector<float> all;
        for (const depth_fit& fit : fits_) all.insert(all.end(), {fit.scale, fit.offset});
        return all;
    }

    std::size_t memory_key(const step& s) const override { return learns_depths(s) ? 1 : 0; }
    float gradient_scale(const step& s) const override { return learns_depths(s) ? pixel_weight(s) : 0; }
    bool learns_depths(const step& s) const override {
        return !fits_.empty() && fits_[s.plan.view].scale > 0 && s.depths != nullptr;
    }
    const float* depth_gradient(const step& s, const float* inverse_depths) override {
        const std::size_t pixels = s.pixels();
        gradient_.resize(3 * pixels);
        device_.for_each_index(pixels, train::depth_gradient{inverse_depths, s.depths, fits_[s.plan.view],
                                                             pixel_weight(s), pixels, gradient_.data()});
        return gradient_.data();
    }

  private:
    /// Returns the weight of the mean error of inverse depths in internal coordinates. It decays
    /// from 1 to 0.01, as in the implementation of Kerbl et al. 2024, which uses units of structure
    /// from motion.
    float weight_at(int iteration) const {
        return static_cast<float>(std::pow(0.01, iterations_.progress(iteration)));
    }

    float pixel_weight(const step& s) const {
        return 3 * weight_at(s.plan.iteration) / static_cast<float>(3 * s.pixels());
    }

    typename Renderer::device_type& device_;
    buffer<float> gradient_;
    std::vector<depth_fit> fits_;  ///< one per training view if the feature is on
    iteration_plan iterations_;
};

}  // namespace gs::features
