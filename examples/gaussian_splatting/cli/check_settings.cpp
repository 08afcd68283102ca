// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "check_settings.hpp"

#include "../core/byte_size.hpp"
#include "../core/error.hpp"

namespace gs::cli {

namespace {

void check_iterations(const std::set<int>& iterations, int last, const std::string& option) {
    if (!iterations.empty() && *iterations.rbegin() > last)
        throw error(option + " names iteration " + std::to_string(*iterations.rbegin()) +
                    ", but there are only iterations 1 to " + std::to_string(last) +
                    ": raise --iterations or leave it out");
}

void check_downscales(train::schedule plan, std::optional<int> num_downscales) {
    plan.num_downscales = num_downscales.value_or(plan.num_downscales);
    const std::int64_t until = std::int64_t{plan.num_downscales} * plan.resolution_interval();
    if (plan.num_downscales > 0 && until >= plan.iterations.last())
        throw error("--num-downscales " + std::to_string(plan.num_downscales) +
                    " with --resolution-schedule " + std::to_string(plan.resolution_interval()) +
                    " trains on whole photos only after iteration " + std::to_string(until) +
                    ", but there are only " + std::to_string(plan.iterations.last()) + ": lower one of them");
}

bool knows_iterations(const settings& s) { return !s.seconds && !s.schedule.iterations.is_corrected(); }

/// Checks the options that name iterations, if the number of iterations is known in advance.
void check_iterations(const settings& s) {
    if (!knows_iterations(s)) return;
    const int last = s.schedule.iterations.last();
    check_iterations(s.save_iterations, last, "--save-iterations");
    check_iterations(s.test_iterations, last, "--test-iterations");
    check_iterations(s.checkpoint_iterations, last, "--checkpoint-iterations");
    check_downscales(s.schedule, s.num_downscales);
}

void check_seconds(const settings& s) {
    if (s.seconds && s.deterministic)
        throw error(
            "--deterministic excludes --seconds, because the speed of the machine then decides the "
            "model: give --iterations instead of --seconds");
}

void check_background(const settings& s) {
    if (s.command != command::train && s.background == background_kind::random)
        throw error("--background random is for train: give " + name_of(s.command) + " white or black");
}

void check_viewer_size(const settings& s) {
    constexpr std::uint64_t least = 200'000;  // the page with camera poses, and a small model
    if (*s.viewer_size < least)
        throw error("--viewer-size " + size_in_bytes(*s.viewer_size) +
                    " is too small for the page itself: give at least " + size_in_bytes(least) +
                    " or --no-viewer");
}

void check_orbit(const settings& s) {
    if (s.given.contains("orbit_views") && !s.scene.data.empty() && !s.orbit)
        throw error("--orbit-views beside --data needs --orbit: add it or leave out --orbit-views");
}

void check_ranks(const settings& s) {
    if (s.ranks == 1 && s.gpus == 1 && !s.mpi) return;
    const std::string option = s.ranks > 1 ? "--ranks" : s.gpus != 1 ? "--gpus" : "--mpi";
    if (s.mpi && option != "--mpi")
        throw error("--mpi trains in the processes that mpirun or srun has started: leave out " + option);
    if (s.ranks > 1 && s.gpus != 1)
        throw error("--ranks trains on the CPU only: leave out --ranks or --gpus");
    if (s.ranks > 1 && s.device == device_kind::cuda)
        throw error("--ranks trains on the CPU only: give --gpus instead, or leave out --device cuda");
    if (s.gpus != 1 && s.device == device_kind::cpu)
        throw error("--gpus trains on GPUs: give --ranks instead, or leave out --device cpu");
    if (s.viewer) throw error(option + " has no live view: leave out " + option + " or --viewer");
    if (s.poses != pose_source::given)
        throw error(option + " needs a scene with camera poses: train with --poses auto and without " +
                    option + " first, and then give the folder colmap of its output as --data");
}

void check_video_frames(const settings& s) {
    if (s.video_frames && s.poses == pose_source::given)
        throw error("--video-frames needs --poses auto: add it or leave out --video-frames");
}

}  // namespace

void check_belongs_to_strategy(const options::option& row, const std::string& strategy) {
    if (row.strategy.empty() || row.strategy == strategy) return;
    throw error(row.name() + " belongs to --strategy " + row.strategy + ", but the strategy is " + strategy +
                ": leave it out or choose that strategy");
}

void set_dependent_values(settings& s) {
    s.scene.seed = s.seed;
    if (s.command == command::train) {
        s.scene.masks = s.effects.allows("masks");
        s.scene.depths = s.effects.allows("depth");
    }
    const bool needs_cameras_only = s.command == command::render || s.command == command::convert;
    if (needs_cameras_only) s.scene.masks = false;
    if (needs_cameras_only || s.command == command::evaluate) s.scene.depths = false;
}

void check_settings(const settings& s) {
    check_seconds(s);
    check_iterations(s);
    constexpr int any_number = static_cast<int>(options::most_iterations);
    s.densification.check({.iterations = knows_iterations(s) ? s.schedule.iterations : any_number,
                           .max_gaussians = s.max_cap.value_or(0),
                           .seed = s.seed});
    check_background(s);
    check_ranks(s);
    check_video_frames(s);
    check_viewer_size(s);
    check_orbit(s);
}

}  // namespace gs::cli
