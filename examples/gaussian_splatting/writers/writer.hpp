// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../cluster/k_means.hpp"
#include "../model/gaussians.hpp"

namespace gs {

/// Options of writing a model. A format ignores options that it cannot express.
struct write_options {
    int max_sh_degree = 3;  ///< 0 to 3; coefficients of higher degrees are dropped
    int spz_version = 4;    ///< 3 or 4: see `spz_writer`
    /// Makes the palette of view-dependent colors in .sog files.
    cluster::k_means_function k_means = cluster::k_means_on_cpu;
};

/// A file format for Gaussians. To add one, write its folder and add a row to the table in
/// writers.cpp.
///
/// A model has the axes of the scene that it was trained on. A format that prescribes other axes
/// converts in both functions.
struct writer {
    std::string_view name;  ///< name in messages, as in "PLY files"

    /// The endings of the files, in lower case. The longest ending that matches decides, so that
    /// one writer may have ".ply" and another ".compressed.ply".
    std::span<const std::string_view> endings;

    /// Writes the file as a whole or not at all: see `atomic_file_write`. Throws `error` with the
    /// file and the value that the format cannot hold, such as one that is not finite.
    void (*write)(const std::filesystem::path& file, const gaussians& model, const write_options& options);

    /// Reads the file back; null for formats that can only be written. Throws `error` with the file
    /// and the field that is malformed. Must not trust sizes in the file before it has compared
    /// them with the size of the file itself.
    gaussians (*read)(const std::filesystem::path& file) = nullptr;

    int max_sh_degree = 3;           ///< the highest SH degree that its files hold
    bool holds_antialiasing = true;  ///< whether its files mark antialiased models
    bool holds_sky = true;           ///< whether its files hold a learned background
    bool clusters_colors = false;    ///< whether `write` uses `write_options::k_means`
};

/// Returns all writers.
std::span<const writer* const> all_writers();

/// Returns the endings of formats that can be read, for messages: ".a, .b or .c" if
/// `last_separator` is " or ".
std::string readable_endings(std::span<const writer* const> writers, const char* last_separator);

/// Returns the endings of all formats, for messages.
std::string writable_endings(std::span<const writer* const> writers, const char* last_separator);

/// Returns what a file in the format of its ending cannot hold of a model, a sentence for each part.
/// Throws `error`, which lists the known endings, for other endings.
std::vector<std::string> left_out(const std::filesystem::path& file, const gaussians& model,
                                  const write_options& options = {},
                                  std::span<const writer* const> writers = all_writers());

/// Returns `writer::holds_sky` of the format of the file's ending. Throws `error` like `left_out`.
bool holds_sky(const std::filesystem::path& file, std::span<const writer* const> writers = all_writers());

/// Returns `writer::clusters_colors` in the same way.
bool clusters_colors(const std::filesystem::path& file,
                     std::span<const writer* const> writers = all_writers());

/// Returns whether the ending of the file, in upper or lower case, selects this writer.
bool has_ending(const std::filesystem::path& file, const writer& format,
                std::span<const writer* const> writers = all_writers());

/// Throws `error`, which lists the known endings, if no format has the ending of the file.
void require_known_ending(const std::filesystem::path& file,
                          std::span<const writer* const> writers = all_writers());

/// Writes a model in the format of the file's ending, in upper or lower case. Throws `error`, which
/// lists the known endings, for other endings. Passes on the errors of `writer::write`.
void write_model(const std::filesystem::path& file, const gaussians& model, const write_options& options = {},
                 std::span<const writer* const> writers = all_writers());

/// Reads a model in the format of the file's ending. Throws `error`, which lists the endings of
/// formats that can be read, for other endings. Passes on the errors of `writer::read`.
gaussians read_model(const std::filesystem::path& file,
                     std::span<const writer* const> writers = all_writers());

}  // namespace gs
