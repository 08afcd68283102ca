// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "point_cloud.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "../core/error.hpp"
#include "../core/file_bytes.hpp"
#include "../core/ply_scalar.hpp"
#include "../core/sanitize_for_message.hpp"
#include "validation.hpp"

namespace gs {
namespace {

constexpr std::array<std::string_view, 6> used_names = {"x", "y", "z", "red", "green", "blue"};
constexpr std::size_t first_color = 3;
constexpr std::uint8_t gray = 128;

constexpr bool is_float(ply_scalar type) {
    return type == ply_scalar::float32 || type == ply_scalar::float64;
}

/// A property of the vertices that is used.
struct column {
    ply_scalar type = ply_scalar::float32;
    std::size_t position = 0;  ///< its number among the properties
    std::size_t offset = 0;    ///< bytes from the beginning of a binary row
    bool exists = false;
};

struct layout {
    bool is_binary = false;
    std::uint64_t count = 0;     ///< number of vertices
    std::size_t properties = 0;  ///< number of properties of a vertex
    std::size_t stride = 0;      ///< bytes of a binary row
    std::array<column, used_names.size()> columns{};

    bool has_color() const { return columns[first_color].exists; }
};

/// Removes the first word of a line and returns it. Returns an empty word at the end.
std::string_view take_word(std::string_view& line) {
    constexpr std::string_view blanks = " \t\r";
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

template <class T>
bool parse(std::string_view word, T& value) {
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    return problem == std::errc() && end == word.data() + word.size();
}

class point_cloud_file {
  public:
    explicit point_cloud_file(const std::filesystem::path& file) : file_(file) {}

    std::vector<colored_point> read() {
        const layout all = read_header();
        check_header(all);
        check_size(all);
        std::vector<colored_point> points;
        points.reserve(static_cast<std::size_t>(all.count));
        std::string row(all.is_binary ? all.stride : 0, '\0');
        for (std::uint64_t i = 0; i < all.count; ++i) {
            std::array<double, used_names.size()> values{};
            if (all.is_binary)
                read_binary_row(all, row, values);
            else
                read_text_row(all, row, i, values);
            points.push_back(point_of(all, values, i));
        }
        return points;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw error(file_.name + ": " + what); }

    layout read_header() {
        std::string line;
        if (!std::getline(file_.in, line) || (line != "ply" && line != "ply\r"))
            fail("it is not a PLY file, which begins with a line 'ply'");
        layout all;
        std::string element;
        while (std::getline(file_.in, line)) {
            std::string_view rest = line;
            const std::string_view word = take_word(rest);
            if (word == "end_header") return all;
            if (word == "format") {
                read_format(all, take_word(rest));
            } else if (word == "element") {
                element = std::string(take_word(rest));
                read_element(all, element, take_word(rest));
            } else if (word == "property" && element == "vertex") {
                add_property(all, rest);
            }
        }
        fail("its header has no end_header");
    }

    void read_format(layout& all, std::string_view format) const {
        all.is_binary = format == "binary_little_endian";
        if (!all.is_binary && format != "ascii")
            fail("its format is '" + sanitize_for_message(format) +
                 "', but only ascii and binary_little_endian are read");
    }

    void read_element(layout& all, std::string_view name, std::string_view count) const {
        if (name == "vertex") {
            if (all.properties > 0) fail("it has two elements 'vertex'");
            if (!parse(count, all.count))
                fail("the count of its vertices is '" + sanitize_for_message(count) + "'");
        } else if (all.properties == 0) {
            fail("its first element is '" + sanitize_for_message(name) + "' instead of 'vertex'");
        }
    }

    void add_property(layout& all, std::string_view rest) const {
        const std::string_view type_name = take_word(rest), name = take_word(rest);
        const auto type = ply_scalar_called(type_name);
        if (!type)
            fail("its property '" + sanitize_for_message(name) + "' has the type '" +
                 sanitize_for_message(type_name) + "', which is not a scalar type");
        const auto used = std::ranges::find(used_names, name);
        if (used != used_names.end()) {
            column& found = all.columns[static_cast<std::size_t>(used - used_names.begin())];
            if (found.exists) fail("it has the property '" + std::string(name) + "' twice");
            found = {*type, all.properties, all.stride, true};
        }
        ++all.properties;
        all.stride += size_of(*type);
    }

    void check_header(const layout& all) const {
        for (std::size_t i = 0; i < used_names.size(); ++i) {
            const std::string name(used_names[i]);
            const column& one = all.columns[i];
            if (i < first_color && !one.exists) fail("its vertices have no property '" + name + "'");
            if (i < first_color && !is_float(one.type))
                fail("its property '" + name + "' is neither float nor double");
            if (i > first_color && one.exists != all.has_color())
                fail("it needs all of red, green and blue, or none of them");
        }
    }

    /// Throws `error` if the vertices do not fit into the file. A value of a text file takes at
    /// least two bytes; only the last one may lack its line end.
    void check_size(const layout& all) {
        const std::uint64_t left = file_.size - static_cast<std::uint64_t>(file_.in.tellg());
        const std::uint64_t shortest = all.is_binary ? all.stride : 2 * all.properties;
        if (all.count > (left + (all.is_binary ? 0 : 1)) / shortest)
            fail("its header announces " + std::to_string(all.count) + " vertices, but only " +
                 std::to_string(left) + " bytes follow");
    }

    void read_binary_row(const layout& all, std::string& row, std::array<double, used_names.size()>& values) {
        file_.in.read(row.data(), static_cast<std::streamsize>(row.size()));
        if (!file_.in) throw error("cannot read " + file_.name);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (const column& one = all.columns[i]; one.exists)
                values[i] = read_ply_scalar(one.type, row.data() + one.offset);
    }

    void read_text_row(const layout& all, std::string& row, std::uint64_t vertex,
                       std::array<double, used_names.size()>& values) {
        if (!std::getline(file_.in, row)) fail("it ends before vertex " + std::to_string(vertex));
        std::string_view rest = row;
        for (std::size_t position = 0; position < all.properties; ++position) {
            const std::string_view word = take_word(rest);
            double value = 0;
            if (!parse(word, value))
                fail("vertex " + std::to_string(vertex) + " has '" + sanitize_for_message(word) +
                     "' instead of a number");
            for (std::size_t i = 0; i < values.size(); ++i)
                if (all.columns[i].exists && all.columns[i].position == position) values[i] = value;
        }
        if (!take_word(rest).empty())
            fail("vertex " + std::to_string(vertex) + " has more than " + std::to_string(all.properties) +
                 " values");
    }

    colored_point point_of(const layout& all, const std::array<double, used_names.size()>& values,
                           std::uint64_t vertex) const {
        colored_point point{{values[0], values[1], values[2]}, glm::u8vec3(gray)};
        if (!is_valid_position(point.position))
            fail("the position of vertex " + std::to_string(vertex) + invalid_position);
        if (!all.has_color()) return point;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool is_share = is_float(all.columns[first_color + i].type);
            const double value = values[first_color + i] * (is_share ? 255 : 1);
            if (!(value >= 0 && value <= 255))
                fail("the color of vertex " + std::to_string(vertex) + " is not within " +
                     (is_share ? "0 to 1" : "0 to 255"));
            point.color[static_cast<glm::length_t>(i)] = static_cast<std::uint8_t>(std::lround(value));
        }
        return point;
    }

    opened_file file_;
};

}  // namespace

std::vector<colored_point> read_point_cloud(const std::filesystem::path& file) {
    return point_cloud_file(file).read();
}

}  // namespace gs
