// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "ply_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>

#include "../core/enumerated.hpp"
#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"

namespace gs {
namespace {

constexpr std::size_t longest_header = 1 << 16;

}  // namespace

std::string_view take_ply_word(std::string_view& line) {
    constexpr std::string_view blanks = " \t\r";  // Windows lines end with \r
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

/// The first three words of a line, the number of its words, and the last word.
struct ply_header::line {
    std::array<std::string_view, 3> words;
    std::size_t count = 0;  ///< number of words; 4 for more than three
    std::string_view last;
};

ply_header::ply_header(opened_file& file, std::span<const std::string_view> names,
                       const std::function<void(std::string_view line)>& on_comment)
    : file_name_(file.name), file_size_(file.size), names_(names) {
    text_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file.size, longest_header)));
    file.in.read(text_.data(), static_cast<std::streamsize>(text_.size()));
    if (!file.in) throw error("cannot read " + file_name_);
    if (!text_.starts_with("ply\n") && !text_.starts_with("ply\r"))
        fail("it is not a PLY file, which begins with a line 'ply'");
    next_ = 4;
    elements_.reserve(names.size());
    properties_.reserve(lines_beginning("property"));
    ply_element* element = nullptr;
    bool format_said = false, element_said = false;
    for (line l = next_line(on_comment); l.words[0] != "end_header"; l = next_line(on_comment)) {
        if (l.words[0] == "format" && l.count == 3) {
            if (l.words[1] != "binary_little_endian") {
                fail("its format is " + sanitize_for_message(l.words[1]) +
                     ", but only binary_little_endian is read");
            }
            format_said = true;
        } else if (l.words[0] == "element" && l.count == 3) {
            element = add_element(l.words[1], l.words[2]);
            element_said = true;
        } else if (l.words[0] == "property" && l.count >= 3 && element_said) {
            if (element) add_property(*element, l);
        } else {
            fail_at_line(l.words[0]);
        }
    }
    if (!format_said) fail("its header has no line 'format'");
}

void ply_header::fail(const std::string& what) const { throw error(file_name_ + ": " + what); }

/// Returns the next line that is neither blank nor a comment.
ply_header::line ply_header::next_line(const std::function<void(std::string_view line)>& on_comment) {
    while (next_ < text_.size()) {
        const std::size_t end = text_.find('\n', next_);
        if (end == std::string::npos) break;
        const std::string_view whole = std::string_view(text_).substr(next_, end - next_);
        std::string_view rest = whole;
        next_ = end + 1;
        line found;
        for (std::string_view word = take_ply_word(rest); !word.empty(); word = take_ply_word(rest)) {
            if (found.count < 3) found.words[found.count] = word;
            found.count = std::min<std::size_t>(found.count + 1, 4);
            found.last = word;
        }
        if (found.count == 0 || found.words[0] == "obj_info") continue;
        if (found.words[0] != "comment") return found;
        on_comment(whole);
    }
    if (text_.size() == longest_header) fail("its header has no end_header in its first 65536 bytes");
    fail("its header has no end_header");
}

/// Throws `error` for an unknown line. If the line is not text, it is data, and the end of the
/// header is missing.
void ply_header::fail_at_line(std::string_view first_word) const {
    const bool text =
        std::all_of(first_word.begin(), first_word.end(), [](char c) { return c > ' ' && c < 127; });
    if (!text) fail("its header has no end_header");
    fail("its header has a line '" + std::string(first_word.substr(0, 40)) + " ...', which is unknown");
}

std::size_t ply_header::lines_beginning(std::string_view word) const {
    std::size_t count = 0;
    for (std::size_t at = text_.find('\n'); at != std::string::npos; at = text_.find('\n', at + 1))
        count += text_.compare(at + 1, word.size(), word) == 0;
    return count;
}

/// Returns the new element, or null for an empty one that is not read.
ply_element* ply_header::add_element(std::string_view name, std::string_view count_text) {
    std::uint64_t count = 0;
    const char* const end = count_text.data() + count_text.size();
    const auto parsed = std::from_chars(count_text.data(), end, count);
    if (parsed.ec != std::errc{} || parsed.ptr != end) {
        fail("the count of its element '" + sanitize_for_message(name) + "' is '" +
             sanitize_for_message(count_text) + "', which is not a count");
    }
    if (find(name)) fail("it has two elements '" + std::string(name) + "'");
    const auto known = std::ranges::find(names_, name);
    if (known == names_.end()) {
        if (count != 0) {
            fail("it has the element '" + sanitize_for_message(name) + "', but only " +
                 enumerated(names_, " and ") + " can be read");
        }
        return nullptr;
    }
    elements_.push_back({*known, count, 0, properties_.size(), properties_.size()});
    return &elements_.back();
}

void ply_header::add_property(ply_element& element, const line& l) {
    const std::string_view name = l.last;
    const std::optional<ply_scalar> type = ply_scalar_called(l.words[1]);
    if (!type || l.count != 3) {
        fail("its property '" + sanitize_for_message(name) + "' has the type '" +
             sanitize_for_message(l.words[1]) + "', which is not a scalar type");
    }
    if (find(element, name)) fail("it has the property '" + sanitize_for_message(name) + "' twice");
    properties_.push_back({name, *type, element.stride});
    element.end_property = properties_.size();
    element.stride += size_of(*type);
}

const ply_element* ply_header::find(std::string_view name) const {
    const auto found = std::ranges::find(elements_, name, &ply_element::name);
    return found == elements_.end() ? nullptr : &*found;
}

std::span<const ply_property> ply_header::properties(const ply_element& element) const {
    return std::span(properties_)
        .subspan(element.first_property, element.end_property - element.first_property);
}

const ply_property* ply_header::find(const ply_element& element, std::string_view name) const {
    const std::span<const ply_property> all = properties(element);
    const auto found = std::ranges::find(all, name, &ply_property::name);
    return found == all.end() ? nullptr : &*found;
}

void ply_header::require_size() const {
    std::uint64_t expected = 0;
    bool fits = true;
    std::vector<std::string> tables;
    for (const ply_element& e : elements_) {
        const std::string rows = e.name == "vertex" ? " vertices" : " rows '" + std::string(e.name) + "'";
        tables.push_back(std::to_string(e.count) + rows + " of " + std::to_string(e.stride) + " bytes");
        if (e.stride == 0) continue;
        fits = fits && e.count <= (std::numeric_limits<std::uint64_t>::max() - expected) / e.stride;
        expected += e.count * e.stride;
    }
    const std::uint64_t found = file_size_ - next_;
    if (fits && expected == found) return;
    fail("its " + enumerated(tables, " and ") + " make " +
         (fits ? std::to_string(expected) : "more than 2^64") + " bytes, but " + std::to_string(found) +
         " bytes follow the header");
}

std::uint64_t ply_header::offset(const ply_element& element) const {
    std::uint64_t bytes = next_;
    for (const ply_element& e : elements_) {
        if (&e == &element) break;
        bytes += e.count * e.stride;
    }
    return bytes;
}

}  // namespace gs
