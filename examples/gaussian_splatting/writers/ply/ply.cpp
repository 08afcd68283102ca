// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "ply.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "../../core/parallel.hpp"
#include "../../core/ply_scalar.hpp"
#include "../ply_comments.hpp"
#include "../ply_header.hpp"

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

std::string header_of(const std::vector<field>& fields, const gaussians& model) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    header += ply_comments(model);
    header += "element vertex " + std::to_string(model.count()) + "\n";
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i == normals_after) header += "property float nx\nproperty float ny\nproperty float nz\n";
        header += "property float " + fields[i].name + "\n";
    }
    return header + "end_header\n";
}

/// The position of a field in the rows of a file.
struct column {
    field to;
    ply_scalar type;
    std::size_t offset;  ///< bytes from the row's beginning
};

/// The part of the header that is needed to read rows.
struct layout {
    std::size_t count = 0;     ///< vertices
    std::size_t stride = 0;    ///< bytes of one
    std::uint64_t offset = 0;  ///< bytes from the beginning of the file
    int sh_degree = 0;
    std::vector<column> columns;
};

constexpr std::string_view elements[] = {"vertex"};

/// Reads one file.
class reader {
  public:
    explicit reader(const std::filesystem::path& file) : file_(file), rows_(file) {}

    gaussians read() {
        read_rows(read_layout());
        return std::move(model_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw error(file_.name + ": " + what); }

    layout read_layout() {
        const ply_header header(
            file_, elements, [this](std::string_view line) { read_ply_comment(line, file_.name, model_); });
        const ply_element* const vertex = header.find(elements[0]);
        if (!vertex || vertex->stride == 0) fail("it has no element 'vertex' with properties");
        layout l;
        l.stride = vertex->stride;
        l.sh_degree = sh_degree(header.properties(*vertex));
        for (const field& f : fields_of_degree(l.sh_degree, 3 * (sh_coefficients(l.sh_degree) - 1))) {
            const ply_property* const source = header.find(*vertex, f.name);
            if (source == nullptr) fail("its vertices have no property '" + f.name + "'");
            l.columns.push_back({f, source->type, source->offset});
        }
        header.require_size();  // before memory is allocated for the count in the header
        l.count = static_cast<std::size_t>(vertex->count);
        l.offset = header.offset(*vertex);
        return l;
    }

    int sh_degree(std::span<const ply_property> properties) const {
        const auto rest = std::ranges::count_if(
            properties, [](const ply_property& p) { return p.name.starts_with("f_rest_"); });
        for (int degree = 0; degree <= 3; ++degree) {
            if (rest == 3 * (sh_coefficients(degree) - 1)) return degree;
        }
        fail("it has " + std::to_string(rest) +
             " properties f_rest_*, but SH degrees 0 to 3 have 0, 9, 24 or 45");
    }

    void read_rows(const layout& l) {
        model_.sh_degree = l.sh_degree;
        for (const column& c : l.columns)
            if (c.to.offset == 0)
                assign_zeros(model_.*c.to.array, l.count * static_cast<std::size_t>(c.to.width));

        // A thread reads few rows at a time. The bound on memory, four times the size of the file, leaves
        // little memory besides the floats if each value takes one byte in the file.
        constexpr std::size_t bytes_at_once = 1 << 14;
        const std::size_t rows_at_once = bytes_at_once / l.stride + 1;
        for_each_in_parallel((l.count + rows_at_once - 1) / rows_at_once, [&](std::size_t block) {
            const std::size_t first = block * rows_at_once;
            const std::size_t count = std::min(rows_at_once, l.count - first);
            std::vector<char> rows(count * l.stride);
            rows_.read(l.offset + first * l.stride, rows.data(), rows.size());
            for (const column& c : l.columns) copy_column(c, l.stride, rows.data(), count, first);
        });
    }

    void copy_column(const column& c, std::size_t stride, const char* rows, std::size_t count,
                     std::size_t first) {
        const auto width = static_cast<std::size_t>(c.to.width);
        float* const values =
            (model_.*c.to.array).data() + first * width + static_cast<std::size_t>(c.to.offset);
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

    opened_file file_;
    shared_file rows_;
    gaussians model_;
};

constexpr std::string_view endings[] = {".ply"};

}  // namespace

void write_ply(const std::filesystem::path& file, const gaussians& model, const write_options& options) {
    const std::vector<field> fields =
        fields_of_degree(std::min(model.sh_degree, options.max_sh_degree), model.rest_width());
    require_finite_sky(file, model);
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
