// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "../core/log.hpp"

namespace gs::poses {

/// Messages for the user, and the progress of the stage that is running.
struct listener {
    log_function say;
    /// Receives the name of the stage, how many of its parts are done, and the number of parts.
    std::function<void(const std::string& stage, int done, int total)> progress;
};

/// A program that computes a part of the result.
struct stage {
    std::string name;  ///< for messages, such as "features"
    std::string program;
    std::vector<std::string> arguments;
    int total = 0;  ///< number of parts
    /// Returns how many parts are done after a line of output, or -1 for a line that does not tell.
    std::function<int(const std::string& line)> parts_done;
};

/// Runs stages. All their command lines and their output are written to one file.
class stage_runner {
  public:
    stage_runner(const std::filesystem::path& log, const listener& user);

    /// Returns the exit status of the program. Throws `interrupted` after Ctrl-C.
    int run(const stage& one);
    /// Like `run`, but throws `error` with the last line of output that explains it if the program
    /// fails.
    void require(const stage& one);

    /// Returns the last line of output that explains a failure of the program that ran last.
    const std::string& explanation() const { return explanation_; }

  private:
    void note(const std::string& line);

    std::ofstream log_;
    const listener& user_;
    std::string explanation_;
    bool has_error_line_ = false;
};

/// Measures the time since its construction.
class stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    /// Returns a text like "3.2 s" or "2:05 min".
    std::string text() const;

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace gs::poses
