// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../engine/feature_state.hpp"
#include "../engine/training_setup.hpp"
#include "../metrics/target_image.hpp"
#include "../model/gaussians.hpp"
#include "../render/renderer.hpp"

namespace gs::features {

/// A training step with one of its views, as the hooks of features see it. Renders and their gradients are
/// three planes on the device.
template <class Renderer>
struct step {
    train::step_plan plan;  ///< of this view
    gs::camera camera;
    train::target_image target;   ///< the photo of the view
    const std::uint16_t* depths;  ///< depth map of the view, in device memory, or null
    Renderer& renderer;
    float gradient_scale;  ///< the largest gradient scale of the loss and of all features
    accumulator accumulate;
    std::size_t place = 0;                 ///< the view among those that the step renders
    const float* transmittance = nullptr;  ///< of each pixel behind all splats: set before `show`

    /// The rows of the view that belong to this rank.
    row_range own_rows() const { return renderer.own_rows(place); }
    std::size_t pixels() const {
        return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    }
};

/// The part of a feature that runs in steps on a device. A step first calls `memory_key` and
/// `gradient_scale`, and then the hooks from `depth_gradient` to `learn_pose` in the order of their
/// declaration, each for all of its views or all for one view after another. None of them may wait for the
/// device.
template <class Renderer>
class device_feature : public train::feature_state {
  public:
    using step = features::step<Renderer>;

    /// Prepares a training run. If the feature is on, a call of `set_values` follows.
    virtual void begin(const train::training_setup&) {}
    virtual void set_views(std::size_t /*training_views*/) {}
    virtual void set_model(const gaussians&) {}
    virtual void get_model(gaussians&) {}

    /// Saves or loads the state that changes during training: see `state_archive`. An archive that
    /// loads has no such state if the feature was off when it was saved.
    virtual void exchange(state_archive&) {}

    /// Returns the memory key. In steps with equal keys, the hooks below must launch the same
    /// kernels over the same ranges and allocate nothing: see `device::graph_key`. The key must
    /// have each host value that affects this, except the number of Gaussians, the capacity of the
    /// tile lists, and the size, lens and mask of the view.
    virtual std::size_t memory_key(const step&) const { return 0; }

    /// Returns the largest magnitude of a gradient per pixel that the feature itself passes to the
    /// renderer: see `loss::gradient_scale`.
    virtual float gradient_scale(const step&) const { return 0; }

    /// Returns the camera of a training view with the pose that the effect has learned. May wait for a
    /// step that used the view. Runs before the first hook of each step, and for other renders.
    virtual camera seen_by(std::size_t /*view*/, const camera& given) { return given; }
    /// Returns whether the feature learns from a depth map of the view. Then `depth_gradient` gets the
    /// render of inverse depths, one plane, and returns the gradient, three planes of which the last two are
    /// zero.
    /// @{
    virtual bool learns_depths(const step&) const { return false; }
    virtual const float* depth_gradient(const step&, const float* /*inverse_depths*/) { return nullptr; }
    /// @}
    /// Returns the learned background of a camera, or null.
    virtual const float* background(const camera&) { return nullptr; }
    /// Applies the effect to a render, so that it matches the target. The hooks of several features
    /// are chained in the order of the table.
    virtual const float* show(const step&, const float* render) { return render; }
    /// Takes the gradient with respect to the result of `show`, and returns the gradient with
    /// respect to its render. Updates the learned values. The hooks are chained in reverse order.
    virtual const float* backward(const step&, const float* gradient) { return gradient; }
    /// Updates learned values from the gradient with respect to the render of the Gaussians.
    virtual void learn(const step&, const float* /*render_gradient*/) {}
    /// Updates the learned pose from the sums of each Gaussian over pixels. Runs before the Gaussians
    /// change, under the rules of the hooks above. See `raster::renderer::backward_to_splats`.
    virtual void learn_pose(const step&, const float* /*sums*/) {}

    /// Hooks for the pose of a held-out view: `begin_refinement` for each view, and then, in each step,
    /// `refined`, which returns the camera, and `refine_pose`. `progress` is from 0 to 1.
    /// @{
    virtual void begin_refinement() {}
    virtual camera refined(const camera& given) { return given; }
    virtual void refine_pose(const step&, const float* /*sums*/, double /*progress*/) {}
    /// @}

    /// Applies the effect to the render of a held-out view.
    virtual const float* show_held_out(std::size_t /*view*/, const float* render, std::size_t /*pixels*/) {
        return render;
    }
};

}  // namespace gs::features
