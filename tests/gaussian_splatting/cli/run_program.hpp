// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"

namespace gs_test {

namespace fs = std::filesystem;
using words = std::vector<std::string>;
using json = nlohmann::json;

words operator+(words some, const words& more);

/// The end of a run of the program and its output.
struct outcome {
    int code;  ///< exit status; -1 after a signal
    std::string out, err;
};

/// Runs gaussian_splatting. `threads`: the value of OMP_NUM_THREADS, or null.
outcome run(const words& arguments, const char* threads = nullptr);

/// Runs gaussian_splatting, and calls `act` with its process and the file that receives its output.
/// `launcher`: words before the program's name, such as mpirun and its options.
outcome run_and_then(const words& arguments, const std::function<void(pid_t, const fs::path&)>& act,
                     const char* threads = nullptr, const words& launcher = {});

/// A run that ends with status 0 and no error output.
void check_success(const words& arguments, const char* threads = nullptr);

/// A run that ends with status 2 and one line, which has all `culprits`.
void check_refusal(const words& arguments, const words& culprits);

/// Also checks that with `-o` the run creates no folder, and changes no folder with earlier results.
void check_refusal_without_trace(const words& arguments, const words& culprits);

/// The files and folders in a folder: relative names, and the bytes of files.
std::map<std::string, std::string> contents(const fs::path& folder);

json read_json(const fs::path& file);

/// Where training writes the model.
fs::path model_of(const fs::path& output, int iteration);

}  // namespace gs_test
