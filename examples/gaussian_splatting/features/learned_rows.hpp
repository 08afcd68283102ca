// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "../device/device.hpp"
#include "../optimize/adam_parameters.hpp"

namespace gs::features {

/// The learned values of a list of cameras, a row of `Width` per view. Adam trains each row on the device
/// in the steps that use its view. The host, which sets the cameras of all renders, gets it before the
/// next of these steps.
template <device::device Device, unsigned Width>
class learned_rows {
  public:
    using row = std::array<float, Width>;

    /// `alone`: whether one rank trains the rows. Otherwise all ranks train them together.
    explicit learned_rows(Device& device, bool alone = false)
        : device_(device), numbers_(device, 0.9f), alone_(alone) {}

    /// Replaces all rows, one after another, and sets Adam's moments to zero.
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

    /// Returns the row of a view. Waits for the last step that trained it.
    row of(std::size_t view) {
        if (trained_) {
            device_.begin_download(reads_[*trained_], on_host_.data() + *trained_ * Width,
                                   numbers_.row(*trained_), Width);
            trained_.reset();
        }
        reads_[view].wait();
        row result;
        std::copy_n(on_host_.data() + view * Width, Width, result.begin());
        return result;
    }

    /// Trains the row of a view in the step `s`. `sums`: see `raster::renderer::backward_to_splats`.
    /// `make_sink` gets `ordered_sums` with a part per warp, and returns a sink of `raster::project_backward`
    /// that adds the gradient of the row to them.
    template <class Step, class MakeSink>
    void learn(std::size_t view, const Step& s, const float* sums, float rate, const MakeSink& make_sink) {
        using narrow = typename Device::narrow_warp;
        const auto parts = numbers_.sums((s.renderer.gaussians() + narrow::size - 1) / narrow::size);
        s.renderer.backward_from_splats(sums, 0, make_sink(parts), nullptr, s.place);
        alone_ ? numbers_.learn_alone(view, parts, rate, s.renderer.capacity())
               : numbers_.learn(view, parts, rate, s.renderer.capacity());
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
    train::adam_parameters<Device, Width> numbers_;
    bool alone_;
    typename Device::template host_buffer<float> on_host_;
    std::vector<typename Device::transfer> reads_;  ///< by view
    std::optional<std::size_t> trained_;            ///< the view whose row the host does not have yet
};

}  // namespace gs::features
