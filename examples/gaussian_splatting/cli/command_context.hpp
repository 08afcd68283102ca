// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "../evaluation/held_out_views.hpp"
#include "../training/trainer.hpp"
#include "settings.hpp"

namespace gs::cli {

/// What every command does before its own work, and how it speaks.
class session {
  public:
    explicit session(const settings& settings) : settings_(settings) {}

    void say(const std::string& line) const;
    /// The scene, in its internal frame.
    scene load() const;
    /// The device that was asked for. Throws `error` where it is not there.
    std::unique_ptr<train::engine> make_engine() const;
    /// `alpha`: the photos (or the model's) have transparent parts.
    train::background_choice background(bool alpha) const;
    /// Throws `error` where the command line names a background that the model's sky would be before.
    void require_no_background_before(const gaussians& model) const;

  private:
    const settings& settings_;
};

/// The folder for the results. Made if it is not there, and taken away again if it stays empty, so that a run
/// that failed leaves nothing behind. Throws `error` where nothing can be written to it.
class output_folder {
  public:
    explicit output_folder(const std::filesystem::path& path);
    output_folder(const output_folder&) = delete;
    output_folder& operator=(const output_folder&) = delete;
    ~output_folder();

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    std::filesystem::path made_;  ///< the topmost folder that was not there before; empty if none
};

/// The measures of a report, as metrics.json holds them: mean and per view, null where there is no test
/// view, or the value is not finite.
nlohmann::ordered_json to_json(const evaluate::test_report& report);
/// ", 23.40 dB after fitting exposures" if they were.
std::string fitted_part(const evaluate::test_report& report);
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

class stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace gs::cli
