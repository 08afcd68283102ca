// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "../device/stages.hpp"
#include "../model/gaussians.hpp"
#include "../render/gradients/accumulator.hpp"
#include "../scene/scene.hpp"
#include "../densify/adaptive/densify_config.hpp"
#include "../optimize/fault_report.hpp"
#include "../losses/loss.hpp"
#include "../metrics/image_quality.hpp"

namespace gs::train {

/// One iteration: which photo, and what it is worth to learn from it.
struct step_plan {
    int iteration = 0;     ///< for what is found not to be finite; less than 2^24
    std::size_t view = 0;  ///< of the training views
    int sh_degree = 0;
    bool updates_sh = true;  ///< else colours that depend on direction are drawn, but stay as they are
    std::array<float, 3> background{};
    accumulator gradient = accumulator::native;
    std::array<float, 8> rates{};  ///< of Adam, by `parameter`
    bool watch = false;       ///< note what `densify` and `prune` want to know
    float exposure_rate = 0;  ///< of Adam; 0: photos are as the scene is, and all of this costs nothing
    float sky_rate = 0;       ///< of Adam, for a model that has a sky
    float depth_weight = 0;   ///< of the mean error of inverse depths, for photos whose depth map has a fit
};

/// See `exposure_kernels.hpp`.
using exposure = std::array<float, 12>;
inline constexpr exposure unexposed{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// A model in training on a device, and all that happens to it. The host says what is done; nothing comes
/// back to it but what it asks for.
class engine {
  public:
    virtual ~engine() = default;

    virtual std::string device_name() const = 0;

    /// The photos of a scene, to learn from and to be measured by. Those to learn from can also be shrunk, by
    /// two, up to `downscales` times.
    virtual void set_views(const std::vector<view>& train, const std::vector<view>& test,
                           int downscales = 0) = 0;
    /// Begins anew with this model: moments zero.
    virtual void set_model(const gaussians& model) = 0;
    virtual gaussians get_model() = 0;
    virtual std::size_t count() const = 0;
    /// The image loss of the following steps, by its name in the table `losses`; at first `default_loss`.
    /// Throws `error` if there is none of this name.
    virtual void set_loss(const std::string& name) = 0;

    /// Steps from now on learn from photos that were shrunk by two this many times: none after `set_views`.
    /// To be followed by `reserve`. Throws `error` if `set_views` was not asked for that many.
    virtual void set_downscales(int times) = 0;
    virtual void step(const step_plan& plan) = 0;
    /// Copies, splits and drops Gaussians by what `step`s have seen since the last call. Returns how many
    /// were drawn while their centres took no gradient, as where alpha is too low everywhere.
    virtual std::uint64_t densify(const densify_rule& rule) = 0;
    /// Drops this share of the Gaussians: those whose centres took the least gradients in all `step`s since
    /// the last `densify` together.
    virtual void prune(double share) = 0;
    virtual void reset_opacity(float most) = 0;
    /// Of the training photos: what `step`s have found, what they are to begin from, and moving them all so
    /// that their mean changes nothing. After `set_model` none changes anything.
    /// @{
    virtual std::vector<exposure> exposures() = 0;
    virtual void set_exposures(const std::vector<exposure>& all) = 0;
    virtual void centre_exposures() = 0;
    /// @}
    /// Of the training photos' depth maps, one each; after `set_views` none has any.
    virtual void set_depth_fits(const std::vector<depth_fit>& all) = 0;
    /// Hides Gaussians nearer to a training camera than the near plane, by an opacity of zero. That camera
    /// does not draw them, so its photo cannot speak against them, and other views' pictures suffer.
    virtual void clear_cameras() = 0;
    /// Makes room for the longest lists of the training views, and for what they may grow to: by how long
    /// each was when a `step` last saw it, and how many Gaussians there are now. To be called after
    /// `set_model` and `densify`, and now and then.
    virtual void reserve() = 0;
    /// The means over the `step`s since the last call.
    virtual loss_report take_training_loss() = 0;
    /// Steps that changed no parameter, since their lists did not fit.
    virtual std::uint64_t skipped_steps() = 0;
    /// What was not finite in the `step`s since the last call. No parameter ever is: see `adam`.
    virtual findings take_findings() = 0;

    /// Three planes, not clamped; without the colours of directions above a degree.
    virtual std::vector<float> render(const camera& camera, const std::array<float, 3>& background,
                                      int sh_degree = 3) = 0;
    /// Colours depend on direction up to this degree from now on: bands above it go, with their memory, and
    /// new ones are zero.
    virtual void set_sh_degree(int degree) = 0;
    /// Takes their bands, with the memory, from Gaussians whose colours hardly depend on direction, and gives
    /// them their mean colours over the training views: as many as by `colour_spread` change these views'
    /// pictures by a root mean square of at most `change`; none if it would be less than a tenth. Returns how
    /// many have bands then. Gaussians change their places, and all have bands again after `densify` and
    /// `prune`. Draws the training views, as small as `set_views` was asked for, and adds up by `how`.
    virtual std::size_t drop_bands(double change, accumulator how) = 0;
    /// What test views are shown with from now on, one each; none: as `render` draws them, as after
    /// `set_views`.
    virtual void set_test_exposures(const std::vector<exposure>& all) = 0;
    /// A test view against its photo, clamped to [0, 1]. `picture`, where there is one, becomes what is
    /// measured, not clamped.
    virtual image_quality measure(std::size_t test_view, const std::array<float, 3>& background,
                                  std::vector<float>* picture = nullptr) = 0;

    /// Times every n-th step from now on. By default, what costs nothing: all on the CPU, every 50th on a
    /// GPU.
    virtual void sample_times(int every) = 0;
    virtual device::stage_times times() = 0;            ///< since `sample_times`, or ever
    virtual std::uint64_t pairs() = 0;                  ///< pixel-Gaussian pairs that steps evaluated forward
    virtual std::size_t peak_device_bytes() const = 0;  ///< zero where that is the host's
    virtual void wait() = 0;
};

/// The CPU's engine, as it was compiled for each instruction set that this machine can run: the best is last.
std::vector<std::unique_ptr<engine> (*)()> cpu_engines();
/// The last of these.
std::unique_ptr<engine> make_cpu_engine();
/// Throws `error` where there is no GPU.
std::unique_ptr<engine> make_cuda_engine();
/// Whether a GPU is there, and why not.
bool cuda_is_available(std::string& reason);

}  // namespace gs::train
