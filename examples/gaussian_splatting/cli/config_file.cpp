// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "config_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "../core/error.hpp"
#include "../core/file_bytes.hpp"
#include "../core/parse_json.hpp"
#include "../core/sanitize_for_message.hpp"
#include "nearest_word.hpp"

namespace gs::cli {
namespace {

using nlohmann::ordered_json;
using words = std::vector<std::string>;

ordered_json options_in(const std::string& file) {
    ordered_json all = parse_json(file_bytes(file), "--config " + file);
    if (!all.is_object()) throw error("--config " + file + " is no JSON object of options");
    const auto given = all.find(given_options_key);
    if (given == all.end()) return all;
    if (!given->is_object())
        throw error("--config " + file + ": the member '" + given_options_key + "' is no object");
    return *given;
}

const option& row_of(const std::string& key, const std::vector<option>& rows, const std::string& file) {
    const auto row = std::ranges::find_if(rows, [&](const option& o) { return o.key() == key; });
    if (row != rows.end()) return *row;
    words known;
    for (const option& o : rows) known.push_back(o.key());
    throw error("--config " + file + ": unknown option '" + sanitize_for_message(key) +
                "'; the nearest known one is " + nearest_word(key, known));
}

bool is_single_value(const ordered_json& value) {
    return value.is_string() || value.is_number() || value.is_boolean();
}

std::string word_of(const ordered_json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::map<std::string, words> read_config(const std::string& file, const std::vector<option>& rows) {
    std::map<std::string, words> all;
    const ordered_json options = options_in(file);
    for (const auto& [key, value] : options.items()) {
        const option& row = row_of(key, rows, file);
        const bool is_switched_off = value == false && row.value.json() == false;
        if (value.is_null() || is_switched_off) continue;
        words given;
        if (is_single_value(value) && (value.is_boolean() == row.value.is_flag())) {
            given.push_back(word_of(value));
        } else if (value.is_array() && row.value.is_list && std::ranges::all_of(value, is_single_value)) {
            for (const ordered_json& element : value) given.push_back(word_of(element));
        } else {
            throw error("--config " + file + ": the option '" + key + "' cannot have the value " +
                        sanitize_for_message(value.dump()));
        }
        if (!given.empty()) all[row.name()] = std::move(given);
    }
    return all;
}

}  // namespace gs::cli
