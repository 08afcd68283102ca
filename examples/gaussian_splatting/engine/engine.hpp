// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "../device/profiler.hpp"
#include "../model/gaussians.hpp"
#include "../scene/scene.hpp"
#include "feature_state.hpp"
#include "step_report.hpp"
#include "training_setup.hpp"

namespace gs::train {

/// A model on a device, and the steps that train it. The engine has state and does single steps; when they
/// happen is up to `training`. Results come back to the host only where a function returns them.
class engine {
  public:
    virtual ~engine() = default;

    /// The views to train on and the held-out views. Every training view is also kept at `downscales` smaller
    /// sizes, each half of the one before.
    virtual void set_views(const std::vector<view>& train, const std::vector<view>& test,
                           int downscales = 0) = 0;
    /// Replaces the model; Adam's moments become zero. Features keep what they have learned besides the
    /// model, such as exposures.
    virtual void set_model(const gaussians& model) = 0;
    virtual gaussians get_model() = 0;

    /// Prepares for a training run: creates the loss and the densification strategy, and gives the features
    /// that are on the values that they begin from. Precondition: views and a model are set.
    virtual void begin(const training_setup& setup) = 0;
    /// Sizes the tile lists for the training views, downsampled by two `downscales` times, and for their
    /// growth. Later steps use views of that size. Call it when the number of Gaussians has changed, and now
    /// and then. Waits for the device.
    virtual void reserve(int downscales = 0) = 0;
    /// One training step. It changes no parameter if the tile lists do not fit.
    virtual void step(const step_plan& plan) = 0;
    /// `strategy::run`. Returns the number of Gaussians that were rendered and received no gradient.
    virtual std::uint64_t densify(int iteration) = 0;
    /// `strategy::adjust`.
    virtual void adjust(int iteration) = 0;
    /// What the steps since the last call came to. Waits for the device.
    virtual step_report take_report() = 0;

    /// The state of a feature. Precondition: a feature of this name has a part on the device.
    virtual feature_state& feature(std::string_view name) = 0;

    /// Three planes, not clamped, with SH bands up to a degree.
    virtual std::vector<float> render(const camera& camera, const std::array<float, 3>& background,
                                      int sh_degree = 3) = 0;
    /// Compares a held-out view with its photo, both clamped to [0, 1]. If `render` is not null, it receives
    /// the render, not clamped.
    virtual image_quality measure(std::size_t test_view, const std::array<float, 3>& background,
                                  std::vector<float>* render = nullptr) = 0;

    std::size_t count() const { return count_; }
    /// When the strategy of `begin` acts.
    const train::timetable& timetable() const { return *timetable_; }
    device::profiler& profile() { return *profiler_; }

  protected:
    std::size_t count_ = 0;  ///< Gaussians
    const train::timetable* timetable_ = nullptr;
    device::profiler* profiler_ = nullptr;
};

/// The CPU's engines, compiled for each instruction set that this machine can run; the best is last.
std::vector<std::unique_ptr<engine> (*)()> cpu_engines();
/// The last of these.
std::unique_ptr<engine> make_cpu_engine();
/// Throws `error` if there is no GPU.
std::unique_ptr<engine> make_cuda_engine();
/// Whether a GPU can be used; if not, `reason` becomes why.
bool cuda_is_available(std::string& reason);

}  // namespace gs::train
