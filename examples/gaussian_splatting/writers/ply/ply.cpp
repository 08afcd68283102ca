// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "ply.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "../../core/ply_scalar.hpp"
#include "../../core/sanitize_for_message.hpp"

namespace gs {
namespace {

/// One float of a Gaussian: its name in the file, its array in the model, and its position in the
/// array.
struct field {
    std::string name;
    std::vector<float> gaussians::*array;
    int width;   ///< floats per Gaussian in `array`
    int offset;  ///< position of this float among them
};

void add_numbered(std::vector<field>& fields, const char* prefix, std::vector<float> gaussians::*array,
                  int width) {
    for (int i = 0; i < width; ++i) fields.push_back({prefix + std::to_string(i), array, width, i});
}

/// Returns the fields in the order of the reference implementation, without normals. In the file,
/// f_rest is channel-major. In the model, which has `rest_width` floats per Gaussian, it is
/// coefficient-major.
std::vector<field> fields_of_degree(int sh_degree, int rest_width) {
    std::vector<field> fields = {
        {"x", &gaussians::mean, 3, 0}, {"y", &gaussians::mean, 3, 1}, {"z", &gaussians::mean, 3, 2}};
    add_numbered(fields, "f_dc_", &gaussians::sh_constant, 3);
    const int per_channel = sh_coefficients(sh_degree) - 1;
    for (int i = 0; i < 3 * per_channel; ++i) {
        const int offset = 3 * (i % per_channel) + i / per_channel;
        fields.push_back({"f_rest_" + std::to_string(i), &gaussians::sh_rest, rest_width, offset});
    }
    fields.push_back({"opacity", &gaussians::opacity, 1, 0});
    add_numbered(fields, "scale_", &gaussians::log_scale, 3);
    add_numbered(fields, "rot_", &gaussians::quaternion, 4);
    return fields;
}

constexpr std::size_t normals_after = 3;  ///< number of fields before the normals: x y z
constexpr std::size_t normals = 3;

/// The header comment for Gaussians that were trained with a 2D Mip filter. Brush writes it, and
/// other viewers read it.
constexpr std::string_view render_mode = "SplatRenderMode:", mip = "mip";
/// The header comment of this program for `gaussians::sky`.
constexpr std::string_view sky_harmonics = "SkyHarmonics:";

std::string header_of(const std::vector<field>& fields, const gaussians& model) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    if (model.antialiased) header += "comment " + std::string(render_mode) + " " + std::string(mip) + "\n";
    if (!model.sky.empty()) {
        header += "comment " + std::string(sky_harmonics);
        for (const float x : model.sky) {
            char text[32];
            header += ' ' + std::string(text, std::to_chars(text, text + sizeof text, x).ptr);
        }
        header += '\n';
    }
    header += "element vertex " + std::to_string(model.count()) + "\n";
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i == normals_after) header += "property float nx\nproperty float ny\nproperty float nz\n";
        header += "property float " + fields[i].name + "\n";
    }
    return header + "end_header\n";
}

struct property {
    std::string_view name;  ///< a part of the header
    ply_scalar type;
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

/// The position of a field in the rows of a file.
struct column {
    field to;
    ply_scalar type;
    std::size_t offset;  ///< bytes from the row's beginning
};

/// The part of the header that is needed to read rows.
struct layout {
    std::size_t count = 0;   ///< vertices
    std::size_t stride = 0;  ///< bytes of one
    int sh_degree = 0;
    std::vector<column> columns;
};

/// Removes the first word of a line and returns it. Returns an empty word at the end. The \r of a
/// Windows line end is blank.
std::string_view take_word(std::string_view& line) {
    constexpr std::string_view blanks = " \t\r";
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

/// Reads one file.
class reader {
  public:
    explicit reader(const std::filesystem::path& file) : file_(file) {}

    gaussians read() {
        const layout l = read_layout();
        std::string().swap(text_);  // frees memory; names are not used from here on
        return read_rows(l);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw error(file_.name + ": " + what); }

    /// The first three words of a line, the number of its words, and the last word.
    struct line {
        std::array<std::string_view, 3> words;
        std::size_t count = 0;  ///< number of words; 4 for more than three
        std::string_view last;
    };

    /// Returns the next line that is neither blank nor a comment.
    line next_line() {
        while (next_ < text_.size()) {
            const std::size_t end = text_.find('\n', next_);
            if (end == std::string::npos) break;
            const std::string_view whole = std::string_view(text_).substr(next_, end - next_);
            std::string_view rest = whole;
            next_ = end + 1;
            line found;
            for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
                if (found.count < 3) found.words[found.count] = word;
                found.count = std::min<std::size_t>(found.count + 1, 4);
                found.last = word;
            }
            if (found.count == 0 || found.words[0] == "obj_info") continue;
            if (found.words[0] != "comment") return found;
            antialiased_ = antialiased_ || (found.words[1] == render_mode && found.words[2] == mip);
            if (found.words[1] == sky_harmonics) read_sky(whole);
        }
        if (text_.size() == longest_header) fail("its header has no end_header in its first 65536 bytes");
        fail("its header has no end_header");
    }

    void read_sky(std::string_view rest) {
        for (int skipped = 0; skipped < 2; ++skipped) take_word(rest);
        sky_.clear();
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            float value = 0;
            const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (problem != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
                fail("its sky has '" + sanitize_for_message(word) + "', which is not a finite number");
            if (sky_.size() == sky_width)
                fail("its sky has more than " + std::to_string(sky_width) + " numbers");
            sky_.push_back(value);
        }
        if (sky_.size() < sky_width)
            fail("its sky has " + std::to_string(sky_.size()) + " numbers instead of " +
                 std::to_string(sky_width));
    }

    /// Reads the header from the first bytes of the file. They stay in `text_`, because names refer
    /// to them.
    header read_header() {
        text_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file_.size, longest_header)));
        file_.in.read(text_.data(), static_cast<std::streamsize>(text_.size()));
        if (!file_.in) throw error("cannot read " + file_.name);
        check_magic();
        header h;
        h.properties.reserve(lines_beginning("property"));
        std::string_view element;
        bool format_said = false;
        for (line l = next_line(); l.words[0] != "end_header"; l = next_line()) {
            if (l.words[0] == "format" && l.count == 3) {
                if (l.words[1] != "binary_little_endian") {
                    fail("its format is " + sanitize_for_message(l.words[1]) +
                         ", but only binary_little_endian is read");
                }
                format_said = true;
            } else if (l.words[0] == "element" && l.count == 3) {
                if (l.words[1] == "vertex" && !h.properties.empty()) fail("it has two elements 'vertex'");
                add_element(h, l.words[1], l.words[2]);
                element = l.words[1];
            } else if (l.words[0] == "property" && l.count >= 3 && !element.empty()) {
                if (element == "vertex") add_property(h, l);
            } else {
                fail_at_line(l.words[0]);
            }
        }
        if (!format_said) fail("its header has no line 'format'");
        if (h.properties.empty()) fail("it has no element 'vertex' with properties");
        return h;
    }

    std::size_t lines_beginning(std::string_view word) const {
        std::size_t count = 0;
        for (std::size_t at = text_.find('\n'); at != std::string::npos; at = text_.find('\n', at + 1))
            count += text_.compare(at + 1, word.size(), word) == 0;
        return count;
    }

    /// Throws `error` for an unknown line. If the line is not text, it is data, and the end of the
    /// header is missing.
    [[noreturn]] void fail_at_line(std::string_view first_word) const {
        const bool text =
            std::all_of(first_word.begin(), first_word.end(), [](char c) { return c > ' ' && c < 127; });
        if (!text) fail("its header has no end_header");
        fail("its header has a line '" + std::string(first_word.substr(0, 40)) + " ...', which is unknown");
    }

    void check_magic() {
        if (!text_.starts_with("ply\n") && !text_.starts_with("ply\r"))
            fail("it is not a PLY file, which begins with a line 'ply'");
        next_ = 4;
    }

    void add_element(header& h, std::string_view name, std::string_view count_text) const {
        std::uint64_t count = 0;
        const char* const end = count_text.data() + count_text.size();
        const auto parsed = std::from_chars(count_text.data(), end, count);
        if (parsed.ec != std::errc{} || parsed.ptr != end) {
            fail("the count of its element '" + sanitize_for_message(name) + "' is '" +
                 sanitize_for_message(count_text) + "', which is not a count");
        }
        if (name == "vertex") {
            h.count = count;
        } else if (count != 0) {
            fail("it has the element '" + sanitize_for_message(name) + "', but only 'vertex' is read");
        }
    }

    void add_property(header& h, const line& l) const {
        const std::string_view name = l.last;
        const std::optional<ply_scalar> type = ply_scalar_called(l.words[1]);
        if (!type || l.count != 3) {
            fail("its property '" + sanitize_for_message(name) + "' has the type '" +
                 sanitize_for_message(l.words[1]) + "', which is not a scalar type");
        }
        if (h.find(name) != nullptr) fail("it has the property '" + sanitize_for_message(name) + "' twice");
        h.properties.push_back({name, *type, h.stride});
        h.stride += size_of(*type);
    }

    layout read_layout() {
        const header h = read_header();
        layout l;
        l.stride = h.stride;
        l.sh_degree = sh_degree(h);
        for (const field& f : fields_of_degree(l.sh_degree, 3 * (sh_coefficients(l.sh_degree) - 1))) {
            const property* const source = h.find(f.name);
            if (source == nullptr) fail("its vertices have no property '" + f.name + "'");
            l.columns.push_back({f, source->type, source->offset});
        }
        check_size(h);  // before memory is allocated for the count in the header
        l.count = static_cast<std::size_t>(h.count);
        return l;
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
        const std::uint64_t found = file_.size - next_;
        const bool fits = h.count <= std::numeric_limits<std::uint64_t>::max() / h.stride;
        if (fits && h.count * h.stride == found) return;
        const std::string expected = fits ? std::to_string(h.count * h.stride) : "more than 2^64";
        fail("its " + std::to_string(h.count) + " vertices of " + std::to_string(h.stride) + " bytes make " +
             expected + " bytes, but " + std::to_string(found) + " bytes follow the header");
    }

    gaussians read_rows(const layout& l) {
        gaussians model;
        model.sh_degree = l.sh_degree;
        model.antialiased = antialiased_;
        model.sky = sky_;
        for (const column& c : l.columns)
            (model.*c.to.array).resize(l.count * static_cast<std::size_t>(c.to.width));

        // Reads few rows at a time. The bound on memory, four times the size of the file, leaves
        // little memory besides the floats if each value takes one byte in the file.
        constexpr std::size_t bytes_at_once = 1 << 14;
        const std::size_t rows_at_once = std::min(l.count, bytes_at_once / l.stride + 1);
        std::vector<char> rows(rows_at_once * l.stride);
        file_.in.seekg(static_cast<std::streamoff>(next_));
        for (std::size_t first = 0; first < l.count; first += rows_at_once) {
            const std::size_t read = std::min(rows_at_once, l.count - first);
            file_.in.read(rows.data(), static_cast<std::streamsize>(read * l.stride));
            if (!file_.in) throw error("cannot read " + file_.name);
            for (const column& c : l.columns) copy_column(c, l.stride, rows.data(), read, first, model);
        }
        return model;
    }

    void copy_column(const column& c, std::size_t stride, const char* rows, std::size_t count,
                     std::size_t first, gaussians& model) const {
        const auto width = static_cast<std::size_t>(c.to.width);
        float* const values =
            (model.*c.to.array).data() + first * width + static_cast<std::size_t>(c.to.offset);
        for (std::size_t i = 0; i < count; ++i) {
            const double value = read_ply_scalar(c.type, rows + i * stride + c.offset);
            // NaN fails this condition, too. So do doubles beyond the range of float.
            if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
                fail("the property '" + c.to.name + "' of vertex " + std::to_string(first + i) +
                     " is not a finite float");
            }
            values[i * width] = static_cast<float>(value);
        }
    }

    static constexpr std::size_t longest_header = 1 << 16;

    opened_file file_;
    std::string text_;      ///< the first bytes of the file, at most `longest_header`
    std::size_t next_ = 0;  ///< position of the next line
    bool antialiased_ = false;
    std::vector<float> sky_;
};

constexpr std::string_view endings[] = {".ply"};

}  // namespace

void write_ply(const std::filesystem::path& file, const gaussians& model, const write_options& options) {
    const std::vector<field> fields =
        fields_of_degree(std::min(model.sh_degree, options.max_sh_degree), model.rest_width());
    if (!std::ranges::all_of(model.sky, [](float x) { return std::isfinite(x); }))
        throw error("cannot write " + file.string() + ": its sky is not finite");
    atomic_file_write(file, [&](std::ostream& out) {
        out << header_of(fields, model);
        std::vector<float> row(fields.size() + normals, 0.0F);
        for (std::size_t i = 0; i < model.count(); ++i) {
            for (std::size_t j = 0; j < fields.size(); ++j) {
                const field& f = fields[j];
                const std::size_t place =
                    i * static_cast<std::size_t>(f.width) + static_cast<std::size_t>(f.offset);
                const float value = (model.*f.array)[place];
                if (!std::isfinite(value))
                    throw error("cannot write " + file.string() + ": the property '" + f.name +
                                "' of vertex " + std::to_string(i) + " is not finite");
                row[j < normals_after ? j : j + normals] = value;
            }
            out.write(reinterpret_cast<const char*>(row.data()),
                      static_cast<std::streamsize>(row.size() * sizeof(float)));
        }
    });
}

gaussians read_ply(const std::filesystem::path& file) { return reader(file).read(); }

constinit const writer ply_writer{"PLY", endings, write_ply, read_ply};

}  // namespace gs
