// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "../evaluation/lpips/lpips.hpp"
#include "../training/training.hpp"
#include "settings.hpp"

namespace gs::cli {

/// The steps that several commands share.
class command_context {
  public:
    explicit command_context(const settings& settings) : settings_(settings) {}

    /// Prints a line, or a warning, if --log-level allows it.
    /// @{
    void say(const std::string& line) const;
    void warn(const std::string& line) const;
    /// @}
    /// Reads the scene and transforms it to internal coordinates: see `normalize`.
    scene load() const { return load(settings_.scene); }
    scene load(const load_options& source) const;
    /// Returns whether --device allows a GPU and one can be used. Throws `error` for --device cuda if
    /// none can be used.
    bool can_use_cuda() const;
    /// Returns an engine for the device of --device. Throws `error` for --device cuda if no GPU can
    /// be used.
    std::unique_ptr<train::engine> make_engine() const;
    /// Returns the network with the weights of --lpips, or null without this option.
    std::unique_ptr<evaluate::lpips_network> load_lpips() const;
    /// Returns the background of --background. `alpha`: whether the photos have transparent parts.
    train::background_choice background(bool alpha) const;
    /// Throws `error` if --background is given although the model's learned background replaces it.
    void require_no_background_before(const gaussians& model) const;

  private:
    bool can_use_cuda(std::string& reason) const;

    const settings& settings_;
};

/// The folder for the results, which is created if needed. The destructor removes created folders
/// that are still empty, so that a failed run leaves nothing behind. The constructor throws `error`
/// if files cannot be written to the folder.
class output_folder {
  public:
    explicit output_folder(const std::filesystem::path& path);
    output_folder(const output_folder&) = delete;
    output_folder& operator=(const output_folder&) = delete;
    ~output_folder();

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    std::filesystem::path made_;  ///< the topmost folder that was created, or empty
};

/// Returns whether a folder exists. Waits for one that another machine has just made, because network
/// file systems may show it late.
bool appears(const std::filesystem::path& folder);

class stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace gs::cli
