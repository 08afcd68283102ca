// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace gs {

/// The place of a value in a JSON file: one step per object or array around it, from the outside.
struct json_step {
    std::string key;        ///< name of a member of an object; empty in an array
    std::size_t index = 0;  ///< position, from 0
};
using json_path = std::vector<json_step>;

/// A value that is neither an object nor an array.
struct json_value {
    double number = std::numeric_limits<double>::quiet_NaN();  ///< NaN for all but finite numbers
    const std::string* text = nullptr;                         ///< null for all but strings
    bool is_null = false;
};

/// Receives the content of a JSON file in its order. The default functions do nothing.
class json_events {
  public:
    virtual ~json_events() = default;
    /// An object or an array begins.
    virtual void begin(const json_path&, bool /*is_object*/) {}
    /// An object or an array ends.
    virtual void end(const json_path&) {}
    virtual void value(const json_path&, const json_value&) = 0;
};

/// Reads a JSON file and reports its content, but nothing with more than `deepest` steps. An object
/// or array with `deepest` steps is reported as a `json_value` that is neither number nor string.
/// Throws `error` with the file, line and byte if the file is not valid JSON. It needs memory for
/// the file, but for no document tree.
void read_json(const std::filesystem::path& file, std::size_t deepest, json_events& events);

}  // namespace gs
