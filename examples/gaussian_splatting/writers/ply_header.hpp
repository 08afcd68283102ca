// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../core/file_bytes.hpp"
#include "../core/ply_scalar.hpp"

namespace gs {

/// A property of the rows of an element.
struct ply_property {
    std::string_view name;  ///< a part of the header
    ply_scalar type;
    std::size_t offset;  ///< bytes from the row's beginning
};

/// A table of rows, all of the same size.
struct ply_element {
    std::string_view name;    ///< one of the names that the caller reads
    std::uint64_t count = 0;  ///< rows, as the header specifies; untrusted before `require_size`
    std::size_t stride = 0;   ///< bytes of one row
    std::size_t first_property = 0, end_property = 0;
};

/// The header of a binary, little-endian PLY file.
class ply_header {
  public:
    /// Reads the header from the beginning of an open file. Elements whose names are not among
    /// `names` must be empty. Calls `on_comment` with each line that begins with `comment`. Throws
    /// `error` with the file and the field for: a file that is not PLY, ASCII or big-endian data, a
    /// header beyond 64 KiB, an unknown line or type, an element or a property that occurs twice.
    ply_header(opened_file& file, std::span<const std::string_view> names,
               const std::function<void(std::string_view line)>& on_comment);

    /// Returns the element with this name, or null.
    const ply_element* find(std::string_view name) const;
    std::span<const ply_property> properties(const ply_element& element) const;
    /// Returns the property with this name, or null.
    const ply_property* find(const ply_element& element, std::string_view name) const;

    /// Throws `error` if the rows of all elements do not make the rest of the file. Call it before
    /// you allocate memory for a number of rows.
    void require_size() const;
    /// Returns the number of bytes from the beginning of the file to the rows of an element.
    std::uint64_t offset(const ply_element& element) const;

  private:
    struct line;
    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void fail_at_line(std::string_view first_word) const;
    line next_line(const std::function<void(std::string_view line)>& on_comment);
    ply_element* add_element(std::string_view name, std::string_view count_text);
    void add_property(ply_element& element, const line& l);
    std::size_t lines_beginning(std::string_view word) const;

    const std::string& file_name_;
    std::uint64_t file_size_;
    std::span<const std::string_view> names_;
    std::string text_;      ///< the first bytes of the file; names refer to it
    std::size_t next_ = 0;  ///< position of the next line; in the end, the size of the header
    std::vector<ply_element> elements_;
    std::vector<ply_property> properties_;
};

/// Removes the first word of a line and returns it. Returns an empty word at the end.
std::string_view take_ply_word(std::string_view& line);

}  // namespace gs
