// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "../engine/feature_state.hpp"
#include "../engine/training_setup.hpp"
#include "../model/gaussians.hpp"
#include "../render/renderer.hpp"
#include "../scene/image_pyramid.hpp"

namespace gs::features {

/// A training step as features take part in it. Renders and their gradients are three planes on the device.
template <class Renderer>
struct step {
    const train::step_plan& plan;
    const gs::camera& camera;
    std::size_t level;  ///< how many times the view was downsampled by two
    Renderer& renderer;
    float gradient_scale;  ///< the largest of the loss and of all features
    accumulator accumulate;

    std::size_t pixels() const {
        return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    }
};

/// The part of a feature that takes part in steps on a device. A step calls `memory_key` and
/// `gradient_scale` first and then `before_blend` to `learn` in the order of their declaration. None of them
/// may wait for the device.
template <class Renderer>
class device_feature : public train::feature_state {
  public:
    using step = features::step<Renderer>;

    /// Training begins. The base's `set_values` follows if the feature is on.
    virtual void begin(const train::training_setup&) {}
    virtual void set_views(const image_pyramid&) {}
    virtual void set_model(const gaussians&) {}
    virtual void get_model(gaussians&) {}

    /// Equal keys promise that the hooks below launch the same kernels over the same ranges and allocate
    /// nothing new: see `device::graph_key`. Every host value that decides about that belongs into the key,
    /// except the number of Gaussians, the capacity of the tile lists, and the size, lens and mask of the
    /// view.
    virtual std::size_t memory_key(const step&) const { return 0; }

    /// The largest magnitude of a gradient per pixel that the feature passes to the renderer by itself: see
    /// `loss::gradient_scale`.
    virtual float gradient_scale(const step&) const { return 0; }

    /// After the tile lists are made and before colors are blended.
    virtual void before_blend(const step&) {}
    /// What lies behind the Gaussians, or null.
    virtual const float* background(const camera&) { return nullptr; }
    /// The render as the photo shows it. Hooks of several features chain in the order of the table.
    virtual const float* show(const step&, const float* render) { return render; }
    /// From the gradient with respect to what `show` returned to that with respect to its render; learns.
    /// Hooks chain in the reverse order.
    virtual const float* backward(const step&, const float* gradient) { return gradient; }
    /// Learns from the gradient with respect to the render of the Gaussians.
    virtual void learn(const step&, const float* /*render_gradient*/) {}

    /// A held-out view as its photo would show it.
    virtual const float* show_held_out(std::size_t /*view*/, const float* render, std::size_t /*pixels*/) {
        return render;
    }
};

}  // namespace gs::features
