// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <string_view>

namespace gs::pages {

/// Returns text for the content or an attribute of an HTML element: replaces & < > " and '.
std::string html_escaped(std::string_view text);

/// Returns JSON for the content of a script element. It contains no "<", which could end the
/// element, and replaces bytes that are not UTF-8.
std::string script_json(const nlohmann::ordered_json& json);

/// The parts of a page, by the name of their marker in the template.
using page_parts = std::map<std::string, std::function<void(std::ostream&)>, std::less<>>;

/// Returns a part that is a text.
std::function<void(std::ostream&)> text_part(std::string text);

/// Writes a template, and calls a part in the place of each marker "@name@". Text between two "@"
/// that names no part is written as it is.
void fill_template(std::ostream& out, std::string_view page, const page_parts& parts);

}  // namespace gs::pages
