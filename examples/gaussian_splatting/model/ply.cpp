// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../error.hpp"
#include "../write_aside.hpp"

namespace gs {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY rows are copied as they lie in memory");

/// One float of a Gaussian: what the file calls it, the array it lies in, and where.
struct field {
    std::string name;
    std::vector<float> gaussians::*array;
    int width;   ///< floats a Gaussian has in `array`
    int offset;  ///< the field's place among them
};

void add_numbered(std::vector<field>& fields, const char* prefix, std::vector<float> gaussians::*array,
                  int width) {
    for (int i = 0; i < width; ++i) fields.push_back({prefix + std::to_string(i), array, width, i});
}

/// In the order of the reference implementation, normals left out. The file's f_rest are channel-major, the
/// model's coefficient-major.
std::vector<field> fields_of_degree(int sh_degree) {
    std::vector<field> fields = {
        {"x", &gaussians::mean, 3, 0}, {"y", &gaussians::mean, 3, 1}, {"z", &gaussians::mean, 3, 2}};
    add_numbered(fields, "f_dc_", &gaussians::sh_constant, 3);
    const int per_channel = sh_coefficients(sh_degree) - 1;
    for (int i = 0; i < 3 * per_channel; ++i) {
        const int offset = 3 * (i % per_channel) + i / per_channel;
        fields.push_back({"f_rest_" + std::to_string(i), &gaussians::sh_rest, 3 * per_channel, offset});
    }
    fields.push_back({"opacity", &gaussians::opacity, 1, 0});
    add_numbered(fields, "scale_", &gaussians::log_scale, 3);
    add_numbered(fields, "rot_", &gaussians::quaternion, 4);
    return fields;
}

constexpr std::size_t normals_after = 3;  ///< fields before the normals: x y z
constexpr std::size_t normals = 3;

std::string header_of(const std::vector<field>& fields, std::size_t count) {
    std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i == normals_after) header += "property float nx\nproperty float ny\nproperty float nz\n";
        header += "property float " + fields[i].name + "\n";
    }
    return header + "end_header\n";
}

enum class scalar_type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<scalar_type> scalar_type_called(std::string_view name) {
    using enum scalar_type;
    constexpr std::array<std::pair<std::string_view, scalar_type>, 16> names = {{{"char", int8},
                                                                                 {"uchar", uint8},
                                                                                 {"short", int16},
                                                                                 {"ushort", uint16},
                                                                                 {"int", int32},
                                                                                 {"uint", uint32},
                                                                                 {"float", float32},
                                                                                 {"double", float64},
                                                                                 {"int8", int8},
                                                                                 {"uint8", uint8},
                                                                                 {"int16", int16},
                                                                                 {"uint16", uint16},
                                                                                 {"int32", int32},
                                                                                 {"uint32", uint32},
                                                                                 {"float32", float32},
                                                                                 {"float64", float64}}};
    for (const auto& [known, type] : names) {
        if (name == known) return type;
    }
    return std::nullopt;
}

std::size_t size_of(scalar_type type) {
    switch (type) {
        case scalar_type::int8:
        case scalar_type::uint8:
            return 1;
        case scalar_type::int16:
        case scalar_type::uint16:
            return 2;
        case scalar_type::int32:
        case scalar_type::uint32:
        case scalar_type::float32:
            return 4;
        case scalar_type::float64:
            break;
    }
    return 8;
}

template <typename T>
double read_as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double read_scalar(scalar_type type, const char* bytes) {
    switch (type) {
        case scalar_type::int8:
            return read_as<std::int8_t>(bytes);
        case scalar_type::uint8:
            return read_as<std::uint8_t>(bytes);
        case scalar_type::int16:
            return read_as<std::int16_t>(bytes);
        case scalar_type::uint16:
            return read_as<std::uint16_t>(bytes);
        case scalar_type::int32:
            return read_as<std::int32_t>(bytes);
        case scalar_type::uint32:
            return read_as<std::uint32_t>(bytes);
        case scalar_type::float32:
            return read_as<float>(bytes);
        case scalar_type::float64:
            break;
    }
    return read_as<double>(bytes);
}

struct property {
    std::string name;
    scalar_type type;
    std::size_t offset;  ///< bytes from the row's beginning
};

struct header {
    std::uint64_t count = 0;  ///< vertices
    std::size_t stride = 0;   ///< bytes of one
    std::vector<property> properties;

    const property* find(std::string_view name) const {
        const auto found = std::find_if(properties.begin(), properties.end(),
                                        [name](const property& p) { return p.name == name; });
        return found == properties.end() ? nullptr : &*found;
    }
};

/// Reads one file; knows its name for the messages.
class reader {
  public:
    explicit reader(const std::filesystem::path& file) : name_(file.string()) {
        std::error_code failed;
        size_ = std::filesystem::file_size(file, failed);
        if (failed) throw error("cannot read " + name_ + ": " + failed.message());
        in_.open(file, std::ios::binary);
        if (!in_) throw error("cannot read " + name_);
    }

    gaussians read() {
        const header h = read_header();
        const int degree = sh_degree(h);
        const std::vector<field> fields = fields_of_degree(degree);
        for (const field& f : fields) {
            if (h.find(f.name) == nullptr) fail("its vertices have no property '" + f.name + "'");
        }
        // Before anything is allocated by the header's word.
        check_size(h);
        return read_rows(h, degree, fields);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw error(name_ + ": " + what); }

    /// The words of the next line that is no comment.
    std::vector<std::string> next_line() {
        std::string line;
        while (std::getline(in_, line)) {
            std::istringstream stream(line);  // takes the \r of a Windows line end for a blank
            std::vector<std::string> words;
            for (std::string word; stream >> word;) words.push_back(word);
            if (!words.empty() && words[0] != "comment" && words[0] != "obj_info") return words;
        }
        fail("its header has no end_header");
    }

    header read_header() {
        check_magic();
        header h;
        std::string element;
        bool format_said = false;
        for (std::vector<std::string> words = next_line(); words[0] != "end_header"; words = next_line()) {
            if (words[0] == "format" && words.size() == 3) {
                if (words[1] != "binary_little_endian") {
                    fail("its format is " + words[1] + ", but only binary_little_endian is read");
                }
                format_said = true;
            } else if (words[0] == "element" && words.size() == 3) {
                if (words[1] == "vertex" && !h.properties.empty()) fail("it has two elements 'vertex'");
                add_element(h, words[1], words[2]);
                element = words[1];
            } else if (words[0] == "property" && words.size() >= 3 && !element.empty()) {
                if (element == "vertex") add_property(h, words);
            } else {
                fail_at_line(words[0]);
            }
        }
        if (!format_said) fail("its header says no format");
        if (h.properties.empty()) fail("it has no element 'vertex' with properties");
        return h;
    }

    /// What is no text is data: the header went on into it.
    [[noreturn]] void fail_at_line(const std::string& first_word) const {
        const bool text =
            std::all_of(first_word.begin(), first_word.end(), [](char c) { return c > ' ' && c < 127; });
        if (!text) fail("its header has no end_header");
        fail("its header has a line '" + first_word.substr(0, 40) + " ...', which is not understood here");
    }

    void check_magic() {
        std::array<char, 4> magic{};
        in_.read(magic.data(), magic.size());
        const std::string_view begin(magic.data(), magic.size());
        if (begin != "ply\n" && begin != "ply\r")
            fail("it is not a PLY file, which begins with a line 'ply'");
    }

    void add_element(header& h, const std::string& name, const std::string& count_text) const {
        std::uint64_t count = 0;
        const char* const end = count_text.data() + count_text.size();
        const auto parsed = std::from_chars(count_text.data(), end, count);
        if (parsed.ec != std::errc{} || parsed.ptr != end) {
            fail("the count of its element '" + name + "' is '" + count_text + "', which is no count");
        }
        if (name == "vertex") {
            h.count = count;
        } else if (count != 0) {
            fail("it has the element '" + name + "', but only 'vertex' is read");
        }
    }

    void add_property(header& h, const std::vector<std::string>& words) const {
        const std::string& name = words.back();
        const std::optional<scalar_type> type = scalar_type_called(words[1]);
        if (!type || words.size() != 3) {
            fail("its property '" + name + "' has the type '" + words[1] + "', which is no scalar type");
        }
        if (h.find(name) != nullptr) fail("it has the property '" + name + "' twice");
        h.properties.push_back({name, *type, h.stride});
        h.stride += size_of(*type);
    }

    int sh_degree(const header& h) const {
        const auto rest = std::count_if(h.properties.begin(), h.properties.end(),
                                        [](const property& p) { return p.name.starts_with("f_rest_"); });
        for (int degree = 0; degree <= 3; ++degree) {
            if (rest == 3 * (sh_coefficients(degree) - 1)) return degree;
        }
        fail("it has " + std::to_string(rest) +
             " properties f_rest_*, but SH degrees 0 to 3 have 0, 9, 24 or 45");
    }

    void check_size(const header& h) {
        const std::uint64_t found = size_ - static_cast<std::uint64_t>(in_.tellg());
        const bool fits = h.count <= std::numeric_limits<std::uint64_t>::max() / h.stride;
        if (fits && h.count * h.stride == found) return;
        const std::string expected = fits ? std::to_string(h.count * h.stride) : "more than 2^64";
        fail("its " + std::to_string(h.count) + " vertices of " + std::to_string(h.stride) + " bytes make " +
             expected + " bytes, but " + std::to_string(found) + " bytes follow the header");
    }

    gaussians read_rows(const header& h, int degree, const std::vector<field>& fields) {
        const auto count = static_cast<std::size_t>(h.count);
        gaussians model;
        model.sh_degree = degree;
        for (const field& f : fields) (model.*f.array).resize(count * static_cast<std::size_t>(f.width));

        constexpr std::size_t bytes_at_once = 1 << 18;
        const std::size_t rows_at_once = std::min(count, bytes_at_once / h.stride + 1);
        std::vector<char> rows(rows_at_once * h.stride);
        for (std::size_t first = 0; first < count; first += rows_at_once) {
            const std::size_t read = std::min(rows_at_once, count - first);
            in_.read(rows.data(), static_cast<std::streamsize>(read * h.stride));
            if (!in_) throw error("cannot read " + name_);
            for (const field& f : fields) {
                copy_column(*h.find(f.name), h.stride, rows.data(), read, f, first, model);
            }
        }
        return model;
    }

    void copy_column(const property& from, std::size_t stride, const char* rows, std::size_t count,
                     const field& to, std::size_t first, gaussians& model) const {
        const auto width = static_cast<std::size_t>(to.width);
        float* const column = (model.*to.array).data() + first * width + static_cast<std::size_t>(to.offset);
        for (std::size_t i = 0; i < count; ++i) {
            const double value = read_scalar(from.type, rows + i * stride + from.offset);
            // Written so that NaN fails too; a double beyond the range of float is refused as well.
            if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
                fail("the property '" + to.name + "' of vertex " + std::to_string(first + i) +
                     " is not a finite float");
            }
            column[i * width] = static_cast<float>(value);
        }
    }

    std::string name_;
    std::uint64_t size_ = 0;
    std::ifstream in_;
};

}  // namespace

void write_ply(const std::filesystem::path& file, const gaussians& model) {
    const std::vector<field> fields = fields_of_degree(model.sh_degree);
    write_aside(file, [&](std::ostream& out) {
        out << header_of(fields, model.count());
        std::vector<float> row(fields.size() + normals, 0.0F);
        for (std::size_t i = 0; i < model.count(); ++i) {
            for (std::size_t j = 0; j < fields.size(); ++j) {
                const field& f = fields[j];
                const std::size_t place =
                    i * static_cast<std::size_t>(f.width) + static_cast<std::size_t>(f.offset);
                row[j < normals_after ? j : j + normals] = (model.*f.array)[place];
            }
            out.write(reinterpret_cast<const char*>(row.data()),
                      static_cast<std::streamsize>(row.size() * sizeof(float)));
        }
    });
}

gaussians read_ply(const std::filesystem::path& file) { return reader(file).read(); }

}  // namespace gs
