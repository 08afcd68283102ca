// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "../core/log.hpp"
#include "state_archive.hpp"

namespace gs {

/// The checkpoints of a training run: a folder with one file per checkpoint.
class checkpoint_folder {
  public:
    struct found_checkpoint {
        int iteration;
        std::filesystem::path file;
        state_archive archive;
    };

    explicit checkpoint_folder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::filesystem::path file_of(int iteration) const;

    /// Writes the checkpoint of an iteration. Then removes all older checkpoints but the newest
    /// `keep - 1`. Throws `error` if the file cannot be written; all others then stay.
    void write(int iteration, const state_archive& archive, std::size_t keep) const;

    /// Returns the newest checkpoint that is not damaged, or nothing if no checkpoint exists.
    /// Passes one line per damaged checkpoint to `warn`, and adds ".damaged" to its name. Throws
    /// `error` if all are damaged; then no name changes.
    std::optional<found_checkpoint> newest(const log_function& warn) const;

  private:
    std::map<int, std::filesystem::path> files() const;  ///< by iteration

    std::filesystem::path folder_;
};

}  // namespace gs
