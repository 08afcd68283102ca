// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "../densify/strategy_settings.hpp"
#include "../edit/edit.hpp"
#include "../features/resolve.hpp"
#include "../losses/loss.hpp"
#include "../optimize/moment_precision.hpp"
#include "../options/command.hpp"
#include "../options/enum_names.hpp"
#include "../readers/load_scene.hpp"
#include "../training/first_points.hpp"
#include "../training/schedule.hpp"
#include "../writers/writer.hpp"

namespace gs::cli {

using options::all_values;
using options::command;
using options::name_of;

enum class device_kind { automatic, cpu, cuda };
enum class background_kind { automatic, white, black, random };
enum class pose_source { given, automatic };
enum class quality_preset { fast, balanced, best };
enum class log_level { error, warning, info };
/// How `convert` writes a learned background: as it is if the format can hold it, and otherwise as
/// Gaussians; always as Gaussians; or not at all.
enum class sky_form { automatic, gaussians, none };
enum class up_axis { x, minus_x, y, minus_y, z, minus_z };

/// Returns the words of the command line for an enumeration, in the order of its values.
/// @{
constexpr std::array<std::string_view, 3> names_of(device_kind) { return {"auto", "cpu", "cuda"}; }
constexpr std::array<std::string_view, 4> names_of(background_kind) {
    return {"auto", "white", "black", "random"};
}
constexpr std::array<std::string_view, 2> names_of(pose_source) { return {"given", "auto"}; }
constexpr std::array<std::string_view, 3> names_of(quality_preset) { return {"fast", "balanced", "best"}; }
constexpr std::array<std::string_view, 3> names_of(log_level) { return {"error", "warning", "info"}; }
constexpr std::array<std::string_view, 3> names_of(sky_form) { return {"auto", "gaussians", "none"}; }
constexpr std::array<std::string_view, 6> names_of(up_axis) { return {"x", "-x", "y", "-y", "z", "-z"}; }
/// @}

/// The values of all options. The table in option_table.cpp sets them from the command line.
struct settings {
    cli::command command = command::train;
    load_options scene;
    pose_source poses = pose_source::given;
    std::optional<int> video_frames;
    std::string output;
    std::string html;  ///< web page of inspect; empty if there is none
    std::string ply;
    std::vector<std::string> runs;  ///< folders of the runs that compare reads
    device_kind device = device_kind::automatic;
    background_kind background = background_kind::automatic;
    std::uint64_t seed = 0;
    bool deterministic = false;
    int ranks = 1;                   ///< number of processes that train together on the CPU
    int gpus = 1;                    ///< number of GPUs that train together; 0: all
    bool mpi = false;                ///< whether mpirun or srun has started the processes that train
    std::string config;              ///< file with further options
    nlohmann::ordered_json given{};  ///< values of the options that the user gave, by `option::key`
    cli::log_level log_level = log_level::info;

    quality_preset quality = quality_preset::balanced;
    train::schedule schedule;
    std::optional<double> seconds;  ///< time of training, instead of its iterations, or of a video
    train::strategy_settings densification;
    int batch_size = 1;  ///< number of photos of each iteration
    std::string loss = train::default_loss;
    features::selection effects;
    train::point_source init = train::point_source::automatic;
    std::optional<int> sh_degree;        ///< if unset, `effects` decides
    std::optional<int> num_downscales;   ///< if unset, the size of the photos decides
    std::optional<std::size_t> max_cap;  ///< if unset, the size of the photos decides
    std::optional<std::uint64_t> photo_memory,
        gpu_memory;                                    ///< limits in bytes; if unset, see `memory_limits`
    std::optional<train::moment_precision> precision;  ///< if unset, see `storage_for`
    bool fit_exposure = false;
    std::string lpips;  ///< file of weights; if empty, LPIPS is not computed
    std::set<int> save_iterations;
    bool save_cameras = false;
    std::optional<int> checkpoint_every;  ///< iterations between two checkpoints
    std::set<int> checkpoint_iterations;
    std::size_t keep_checkpoints = 2;
    bool resume = false;
    bool overwrite = false;
    std::set<int> test_iterations;

    bool no_viewer = false;                                 ///< whether train leaves out viewer.html
    std::optional<std::uint64_t> viewer_size = 64'000'000;  ///< largest size of viewer.html in bytes

    int orbit_views = 8;

    write_options export_options;   ///< of `convert`
    std::optional<edit::box> crop;  ///< in the coordinates of the model
    std::optional<edit::share> decimate;
    bool remove_floaters = false;
    sky_form sky = sky_form::automatic;
    std::optional<up_axis> up;
    bool orbit = false;       ///< draws an orbit around a scene instead of its views
    std::string camera_path;  ///< file with key views; empty if there is none
    int frames_per_second = 30;

    std::optional<int> viewer;  ///< port of the live view, or 0 for the default; if unset, there is none
    std::string viewer_host = "127.0.0.1";
};

}  // namespace gs::cli
