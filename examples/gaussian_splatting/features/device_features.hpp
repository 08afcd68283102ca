// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "device_feature.hpp"
#include "table.hpp"

namespace gs::features {

/// The device parts of all features. Each hook of `device_feature` is called for all of them.
template <class Renderer>
class device_features {
  public:
    using step = features::step<Renderer>;
    using part = device_feature<Renderer>;

    explicit device_features(typename Renderer::device_type& device) : device_(device) {
        [&]<class... Features>(std::tuple<Features...>*) {
            (add<Features>(device), ...);
        }(static_cast<table*>(nullptr));
    }

    part& named(std::string_view name) {
        const auto found = std::ranges::find(parts_, name, &named_part::first);
        if (found == parts_.end())
            throw error("the feature '" + std::string(name) + "' has no part on the device");
        return *found->second;
    }

    void begin(const train::training_setup& setup) {
        for (auto& [name, f] : parts_) {
            f->begin(setup);
            if (const auto values = setup.features.find(name); values != setup.features.end())
                f->set_values(values->second);
        }
    }
    void set_views(std::size_t training_views) {
        for (auto& [name, f] : parts_) f->set_views(training_views);
    }
    void set_model(const gaussians& model) {
        for (auto& [name, f] : parts_) f->set_model(model);
    }
    void get_model(gaussians& model) {
        for (auto& [name, f] : parts_) f->get_model(model);
    }

    void exchange(state_archive& archive) {
        for (auto& [name, f] : parts_) {
            const state_archive::scope scope(archive, name);
            f->exchange(archive);
        }
    }

    void add_memory_keys(const step& s, device::graph_key& key) const {
        for (const auto& [name, f] : parts_) key.push_back(f->memory_key(s));
    }
    float gradient_scale(const step& s) const {
        float largest = 0;
        for (const auto& [name, f] : parts_) largest = std::max(largest, f->gradient_scale(s));
        return largest;
    }
    camera seen_by(std::size_t view, camera given) {
        for (auto& [name, f] : parts_) given = f->seen_by(view, given);
        return given;
    }
    bool learns_depths(const step& s) const {
        return std::ranges::any_of(parts_, [&](const auto& named) { return named.second->learns_depths(s); });
    }
    /// Returns the gradient of the first feature that learns from the view's depth map, or null.
    const float* depth_gradient(const step& s, const float* inverse_depths) {
        for (auto& [name, f] : parts_)
            if (f->learns_depths(s)) return f->depth_gradient(s, inverse_depths);
        return nullptr;
    }
    /// Returns the background of the first feature that has one, or null.
    const float* background(const camera& camera) {
        for (auto& [name, f] : parts_)
            if (const float* planes = f->background(camera)) return planes;
        return nullptr;
    }
    const float* show(const step& s, const float* render) {
        const auto scope = exchanging();
        for (auto& [name, f] : parts_) render = f->show(s, render);
        return render;
    }
    const float* backward(const step& s, const float* gradient) {
        const auto scope = exchanging();
        for (auto f = parts_.rbegin(); f != parts_.rend(); ++f) gradient = f->second->backward(s, gradient);
        return gradient;
    }
    void learn(const step& s, const float* render_gradient) {
        const auto scope = exchanging();
        for (auto& [name, f] : parts_) f->learn(s, render_gradient);
    }
    void learn_pose(const step& s, const float* sums) {
        const auto scope = exchanging();
        for (auto& [name, f] : parts_) f->learn_pose(s, sums);
    }
    void begin_refinement() {
        for (auto& [name, f] : parts_) f->begin_refinement();
    }
    camera refined(camera given) {
        for (auto& [name, f] : parts_) given = f->refined(given);
        return given;
    }
    void refine_pose(const step& s, const float* sums, double progress) {
        for (auto& [name, f] : parts_) f->refine_pose(s, sums, progress);
    }
    const float* show_held_out(std::size_t view, const float* render, std::size_t pixels) {
        for (auto& [name, f] : parts_) render = f->show_held_out(view, render, pixels);
        return render;
    }

  private:
    using named_part = std::pair<std::string, std::unique_ptr<part>>;

    template <class Feature>
    void add(typename Renderer::device_type& device) {
        if constexpr (requires { typename Feature::template on_device<Renderer>; })
            parts_.emplace_back(Feature().name(),
                                std::make_unique<typename Feature::template on_device<Renderer>>(device));
    }

    /// Values that features exchange in the hooks of a step count for this purpose.
    ranks::traffic_counter::scope exchanging() {
        return {device_.ranks().traffic(), ranks::purpose::effects};
    }

    typename Renderer::device_type& device_;
    std::vector<named_part> parts_;
};

}  // namespace gs::features
