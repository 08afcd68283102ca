// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "page_text.hpp"

#include <utility>

namespace gs::pages {

std::string html_escaped(std::string_view text) {
    std::string escaped;
    escaped.reserve(text.size());
    for (const char c : text) switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += c;
        }
    return escaped;
}

std::string script_json(const nlohmann::ordered_json& json) {
    const std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string escaped;
    escaped.reserve(text.size());
    // JSON has "<" only within strings, where it may be written as an escape sequence.
    for (const char c : text) escaped += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return escaped;
}

std::function<void(std::ostream&)> text_part(std::string text) {
    return [text = std::move(text)](std::ostream& out) { out << text; };
}

void fill_template(std::ostream& out, std::string_view page, const page_parts& parts) {
    for (std::size_t begin = 0; begin < page.size();) {
        const std::size_t marker = page.find('@', begin), end = page.find('@', marker + 1);
        if (marker == page.npos || end == page.npos) {
            out << page.substr(begin);
            return;
        }
        out << page.substr(begin, marker - begin);
        const auto part = parts.find(page.substr(marker + 1, end - marker - 1));
        if (part == parts.end()) {
            out << page.substr(marker, end - marker);  // the second "@" may begin a marker
            begin = end;
        } else {
            part->second(out);
            begin = end + 1;
        }
    }
}

}  // namespace gs::pages
