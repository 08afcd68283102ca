// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

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

/// The writer with the longest ending that the file has; null if there is none.
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

std::string endings_of(writer_table writers, bool readable) {
    std::string all;
    for (const writer* one : writers)
        if (one->read || !readable)
            for (const std::string_view ending : one->endings)
                all += (all.empty() ? "" : ", ") + std::string(ending);
    return all;
}

}  // namespace

void write_model(const std::filesystem::path& file, const gaussians& model, const write_options& options,
                 writer_table writers) {
    const writer* found = writer_of(file, writers);
    if (!found)
        throw error("cannot write " + file.string() +
                    ": its ending names no known format; known endings are " + endings_of(writers, false));
    found->write(file, model, options);
}

gaussians read_model(const std::filesystem::path& file, writer_table writers) {
    const writer* found = writer_of(file, writers);
    if (!found)
        throw error("cannot read " + file.string() +
                    ": its ending names no known format; known endings are " + endings_of(writers, true));
    if (!found->read)
        throw error("cannot read " + file.string() + ": " + std::string(found->name) +
                    " files can only be written; the endings of formats that can be read are " +
                    endings_of(writers, true));
    return found->read(file);
}

}  // namespace gs
