// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../device/profiler.hpp"
#include "../model/gaussians.hpp"
#include "../photos/photo_plan.hpp"
#include "../scene/scene.hpp"
#include "feature_state.hpp"
#include "learned_cameras.hpp"
#include "photo_prefetch.hpp"
#include "rank_member.hpp"
#include "render_options.hpp"
#include "step_report.hpp"
#include "training_setup.hpp"

namespace gs::train {

/// A model in training on a device, with its optimizer state. The engine does single steps;
/// `training` decides when. Results reach the host only as return values of these functions.
class engine {
  public:
    virtual ~engine() = default;

    /// Sets the training views and the held-out views. Also stores each training view at
    /// `downscales` smaller sizes; each size halves the previous one. If the views are streamed,
    /// loads their photos within `memory` when they are needed.
    virtual void set_views(const std::vector<view>& train, const std::vector<view>& test, int downscales = 0,
                           const photos::photo_plan& memory = {}) = 0;
    /// Replaces the model and sets Adam's moments to zero. An empty `gaussians::sh_rest` means zeros.
    /// Features keep their learned values, such as exposures.
    virtual void set_model(const gaussians& model) = 0;
    virtual gaussians get_model() = 0;

    /// Prepares a training run: creates the loss and the densification strategy, and sets the
    /// initial values of the features that are on. Precondition: views and a model are set.
    virtual void begin(const training_setup& setup) = 0;
    /// Reserves memory for the tile lists of the training views at size level `downscales`, with a
    /// reserve for growth. Later steps use views of that size. Call this after each change of the
    /// number of Gaussians, and at intervals. Waits for the device.
    virtual void reserve(int downscales = 0) = 0;
    /// Does one training step, with the sum of the gradients of the plan's view and of `more_views`. A step
    /// whose tile lists exceed the capacity changes no parameter.
    virtual void step(const step_plan& plan, const std::vector<std::size_t>& more_views = {}) = 0;
    /// Calls `strategy::run`. Returns the number of Gaussians that were drawn but received no
    /// gradient.
    virtual std::uint64_t densify(int iteration) = 0;
    /// Calls `strategy::adjust`.
    virtual void adjust(int iteration) = 0;
    /// Returns the report on the steps since the last call. Waits for the device.
    virtual step_report take_report() = 0;

    /// Returns the state of a feature. Precondition: a feature of this name has state on the
    /// device.
    virtual feature_state& feature(std::string_view name) = 0;

    /// Renders the model. Returns three planes, red, green and blue, of the camera's size, unless the
    /// options ask for a part. The values are not clamped.
    virtual std::vector<float> render(const camera& camera, const std::array<float, 3>& background,
                                      const render_options& options = {}) = 0;
    /// Compares the render of a held-out view with its target, both clamped to [0, 1]. If `render`
    /// is not null, it receives the render, which is not clamped.
    virtual image_quality measure(std::size_t test_view, const std::array<float, 3>& background,
                                  std::vector<float>* render = nullptr) = 0;

    std::size_t count() const { return count_; }
    /// Returns whether the last call of `densify` made as many Gaussians as `max_device_bytes` allows.
    bool lacks_memory() const { return lacks_memory_; }
    /// Returns the lowest SH degree whose coefficients lie in host memory: see `parameter_storage`.
    int first_degree_on_host() const { return first_degree_on_host_; }
    /// Returns the timetable of the densification strategy. Precondition: `begin` was called.
    const train::timetable& timetable() const { return *timetable_; }
    device::profiler& profile() { return *profiler_; }
    /// Returns the state that determines all later steps, for checkpoints. Precondition for saving
    /// it: `take_report` was called after the last step. Precondition for loading it: `begin` was
    /// called, with the same training views.
    checkpointed& state() { return *state_; }
    learned_cameras& cameras() { return *cameras_; }
    rank_member& ranks() { return *ranks_; }
    /// Returns the interface to streamed photos, or null if all photos are in device memory.
    photo_prefetch* streamed_photos() { return photos_; }

  protected:
    std::size_t count_ = 0;  ///< number of Gaussians
    bool lacks_memory_ = false;
    int first_degree_on_host_ = 4;
    const train::timetable* timetable_ = nullptr;
    device::profiler* profiler_ = nullptr;
    checkpointed* state_ = nullptr;
    learned_cameras* cameras_ = nullptr;
    rank_member* ranks_ = nullptr;
    photo_prefetch* photos_ = nullptr;
};

/// Returns a factory of CPU engines for each instruction set that this machine can run, the best
/// one last.
std::vector<std::unique_ptr<engine> (*)()> cpu_engines();
/// Creates a CPU engine for the best instruction set.
std::unique_ptr<engine> make_cpu_engine();
/// Creates a GPU engine. Throws `error` if no GPU can be used.
std::unique_ptr<engine> make_cuda_engine();
/// Returns the number of GPUs that CUDA finds.
int count_gpus();
/// Returns the PCI address of the first GPU that CUDA finds.
std::string bus_id_of_gpu();
/// Returns whether a GPU can be used. If not, sets `reason` to the reason.
bool cuda_is_available(std::string& reason);

}  // namespace gs::train
