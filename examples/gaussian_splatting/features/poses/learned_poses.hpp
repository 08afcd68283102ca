// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "../../device/device.hpp"
#include "../../optimize/adam_parameters.hpp"
#include "pose_gradient.hpp"

namespace gs::features {

/// The pose changes of a list of views. Adam trains each one on the device in the steps that use its
/// view. The host, which sets the cameras of all renders, gets it before the next of these steps.
template <device::device Device>
class learned_poses {
  public:
    /// `alone`: whether one rank trains the changes. Otherwise all ranks train them together.
    explicit learned_poses(Device& device, bool alone = false)
        : device_(device), numbers_(device, 0.9f), alone_(alone) {}

    /// Replaces all changes, `pose_width` values per view, and sets Adam's moments to zero.
    void set(const std::vector<float>& values) {
        numbers_.set(values);
        read_all();
    }
    std::vector<float> get() const { return numbers_.get(); }
    /// Changes all values, and keeps Adam's moments.
    void change(const std::vector<float>& values) {
        numbers_.change(values);
        read_all();
    }

    void exchange(state_archive& archive) {
        numbers_.exchange(archive);
        if (archive.loads()) read_all();
    }

    /// Returns the change of a view. Waits for the last step that trained it.
    pose_change of(std::size_t view) {
        if (trained_) {
            device_.begin_download(reads_[*trained_], on_host_.data() + *trained_ * pose_width,
                                   numbers_.row(*trained_), pose_width);
            trained_.reset();
        }
        reads_[view].wait();
        return change_of({on_host_.data(), on_host_.size()}, view);
    }

    /// Trains the change of a view, which is the same as in the render. `sums`: see
    /// `raster::renderer::backward_to_splats`.
    template <class Renderer>
    void learn(std::size_t view, const given_pose& given, const pose_change& change, Renderer& renderer,
               const float* sums, float rate) {
        using narrow = typename Device::narrow_warp;
        const auto parts = numbers_.sums((renderer.gaussians() + narrow::size - 1) / narrow::size);
        renderer.backward_from_splats(sums, 0, pose_gradient(derivatives_of(given, change), parts), nullptr);
        alone_ ? numbers_.learn_alone(view, parts, rate, renderer.capacity())
               : numbers_.learn(view, parts, rate, renderer.capacity());
        trained_ = view;
    }

  private:
    void read_all() {
        const std::vector<float> values = numbers_.get();
        on_host_.resize(values.size());
        std::ranges::copy(values, on_host_.data());
        reads_ = std::vector<typename Device::transfer>(numbers_.rows());
        trained_.reset();
    }

    Device& device_;
    train::adam_parameters<Device, pose_width> numbers_;
    bool alone_;
    typename Device::template host_buffer<float> on_host_;
    std::vector<typename Device::transfer> reads_;  ///< by view
    std::optional<std::size_t> trained_;            ///< the view whose change the host does not have yet
};

}  // namespace gs::features
