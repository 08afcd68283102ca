// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

#include "../core/enumerated.hpp"
#include "../core/error.hpp"
#include "writer.hpp"

namespace gs {
namespace {

using writer_table = std::span<const writer* const>;

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

/// Returns the writer with the longest matching ending of the file name, or null if no ending
/// matches.
const writer* writer_of(const std::filesystem::path& file, writer_table writers) {
    const std::string name = lower_case(file.filename().string());
    const writer* found = nullptr;
    std::size_t longest = 0;
    for (const writer* one : writers)
        for (const std::string_view ending : one->endings)
            if (ending.size() > longest && name.ends_with(ending)) {
                found = one;
                longest = ending.size();
            }
    return found;
}

std::vector<std::string_view> endings_of(writer_table writers, bool readable) {
    std::vector<std::string_view> all;
    for (const writer* one : writers)
        if (one->read || !readable) all.insert(all.end(), one->endings.begin(), one->endings.end());
    return all;
}

const writer& known_writer_of(const std::filesystem::path& file, writer_table writers) {
    const writer* found = writer_of(file, writers);
    if (!found)
        throw error("cannot write " + file.string() +
                    ": its ending names no known format; known endings are " +
                    writable_endings(writers, " and "));
    return *found;
}

}  // namespace

std::string writable_endings(writer_table writers, const char* last_separator) {
    return enumerated(endings_of(writers, false), last_separator);
}

std::vector<std::string> left_out(const std::filesystem::path& file, const gaussians& model,
                                  const write_options& options, writer_table writers) {
    const writer& format = known_writer_of(file, writers);
    std::vector<std::string> sentences;
    const auto add = [&](const char* what) {
        sentences.push_back(file.string() + " leaves out the " + what + ": " + std::string(format.name) +
                            " files cannot hold it; .ply files can");
    };
    if (model.count() > 0 && std::min(model.sh_degree, options.max_sh_degree) > format.max_sh_degree)
        add("view dependence of colors");
    if (model.antialiased && !format.holds_antialiasing) add("mark of antialiasing");
    if (!model.sky.empty() && !format.holds_sky) add("learned background");
    return sentences;
}

bool holds_sky(const std::filesystem::path& file, writer_table writers) {
    return known_writer_of(file, writers).holds_sky;
}

bool clusters_colors(const std::filesystem::path& file, writer_table writers) {
    return known_writer_of(file, writers).clusters_colors;
}

bool has_ending(const std::filesystem::path& file, const writer& format, writer_table writers) {
    return writer_of(file, writers) == &format;
}

void require_known_ending(const std::filesystem::path& file, writer_table writers) {
    known_writer_of(file, writers);
}

std::string readable_endings(writer_table writers, const char* last_separator) {
    return enumerated(endings_of(writers, true), last_separator);
}

void write_model(const std::filesystem::path& file, const gaussians& model, const write_options& options,
                 writer_table writers) {
    known_writer_of(file, writers).write(file, model, options);
}

gaussians read_model(const std::filesystem::path& file, writer_table writers) {
    const writer* found = writer_of(file, writers);
    if (!found)
        throw error("cannot read " + file.string() +
                    ": its ending names no known format; known endings are " +
                    readable_endings(writers, " and "));
    if (!found->read)
        throw error("cannot read " + file.string() + ": " + std::string(found->name) +
                    " files can only be written; the endings of formats that can be read are " +
                    readable_endings(writers, " and "));
    return found->read(file);
}

}  // namespace gs
