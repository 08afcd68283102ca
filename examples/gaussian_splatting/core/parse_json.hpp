// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "error.hpp"

namespace gs {

/// Parses JSON of untrusted origin. Throws `error` if `text` is no JSON, or nests more than 32 levels,
/// which could exhaust the stack later. `what` begins the message, such as "the file a.json".
template <class Json = nlohmann::ordered_json>
Json parse_json(const std::string& text, const std::string& what) {
    constexpr int most_levels = 32;
    bool is_shallow = true;
    const auto check = [&](int depth, typename Json::parse_event_t, Json&) {
        is_shallow = is_shallow && depth <= most_levels;
        return is_shallow;
    };
    Json parsed = Json::parse(text, check, false);
    if (parsed.is_discarded() || !is_shallow) throw error(what + " is no valid JSON");
    return parsed;
}

}  // namespace gs
