// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "compressed_ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "../../model/morton_order.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../ply_comments.hpp"
#include "../ply_header.hpp"
#include "../quantize.hpp"
#include "../require_writable.hpp"
#include "../smallest_three.hpp"

namespace gs {
namespace {

constexpr std::size_t chunk_size = 256;  ///< Gaussians
constexpr double least_log_scale = -20, most_log_scale = 20;
constexpr double sh_range = 8;  ///< SH coefficients are from -4 to 4

constexpr std::array<const char*, 18> chunk_properties{
    "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
    "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
    "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
constexpr std::array<const char*, 4> vertex_properties{"packed_position", "packed_rotation", "packed_scale",
                                                       "packed_color"};
constexpr std::string_view elements[] = {"chunk", "vertex", "sh"};

/// The range of three values in a chunk, as the file has it: three minima, and three maxima.
struct range {
    std::array<float, 6> bounds;

    void include(std::size_t k, float x) {
        bounds[k] = std::min(bounds[k], x);
        bounds[3 + k] = std::max(bounds[3 + k], x);
    }
    static range empty() {
        constexpr float most = std::numeric_limits<float>::max();
        return {{most, most, most, -most, -most, -most}};
    }
    std::uint32_t quantized(std::size_t k, float x, std::uint32_t most) const {
        const double low = bounds[k], high = bounds[3 + k];
        return high > low ? to_unorm((x - low) / (high - low), most) : 0;
    }
    float value(std::size_t k, std::uint32_t quantized, std::uint32_t most) const {
        const double t = static_cast<double>(quantized) / most;
        return static_cast<float>((1 - t) * double(bounds[k]) + t * double(bounds[3 + k]));
    }
};

/// The number of bits of three values in 32 bits, the first in the highest bits.
constexpr std::array<int, 3> bits_111011{11, 10, 11};

std::uint32_t pack_111011(const range& r, const float* values) {
    std::uint32_t packed = 0;
    for (std::size_t k = 0; k < 3; ++k)
        packed = packed << bits_111011[k] | r.quantized(k, values[k], (1U << bits_111011[k]) - 1);
    return packed;
}

void unpack_111011(const range& r, std::uint32_t packed, float* values) {
    for (std::size_t k = 3; k-- > 0; packed >>= bits_111011[k]) {
        const std::uint32_t most = (1U << bits_111011[k]) - 1;
        values[k] = r.value(k, packed & most, most);
    }
}

std::uint32_t pack_rotation(const float* q) {
    const smallest_three three = smallest_three_of({q[0], q[1], q[2], q[3]});
    auto packed = static_cast<std::uint32_t>(three.largest);
    for (const double x : three.others) packed = packed << 10 | to_unorm((x + 1) / 2, 1023);
    return packed;
}

void unpack_rotation(std::uint32_t packed, float* q) {
    smallest_three three{packed >> 30, {}};
    for (std::size_t k = 3; k-- > 0; packed >>= 10) three.others[k] = 2.0 * (packed & 1023) / 1023 - 1;
    const std::array<double, 4> all = quaternion_of(three);
    std::ranges::transform(all, q, [](double x) { return static_cast<float>(x); });
}

std::uint8_t pack_sh(float x) {
    return static_cast<std::uint8_t>(std::clamp(std::floor((x / sh_range + 0.5) * 256), 0.0, 255.0));
}

float unpack_sh(std::uint8_t x) {
    const double share = x == 0 ? 0 : x == 255 ? 1 : (x + 0.5) / 256;
    return static_cast<float>((share - 0.5) * sh_range);
}

float clamped_log_scale(float x) {
    return std::clamp(x, static_cast<float>(least_log_scale), static_cast<float>(most_log_scale));
}

float color_of(float sh_constant) { return static_cast<float>(0.5 + sh_c0 * double(sh_constant)); }

struct chunk {
    range position = range::empty(), scale = range::empty(), color = range::empty();
};
static_assert(sizeof(chunk) == sizeof(float) * chunk_properties.size());

using packed_vertex = std::array<std::uint32_t, 4>;
static_assert(std::endian::native == std::endian::little, "rows are written as they lie in memory");

template <class T>
void write_raw(std::ostream& out, const T* values, std::size_t count) {
    out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

class compressed_output {
  public:
    compressed_output(const gaussians& model, int sh_degree)
        : model_(model),
          order_(morton_order(model.mean)),
          coefficients_(static_cast<std::size_t>(sh_coefficients(sh_degree) - 1)) {}

    void write(std::ostream& out) const {
        write_header(out);
        const std::vector<chunk> chunks = chunks_of_model();
        write_raw(out, chunks.data(), chunks.size());
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const packed_vertex packed = pack(chunks[i / chunk_size], order_[i]);
            write_raw(out, packed.data(), packed.size());
        }
        if (coefficients_ > 0) write_sh(out);
    }

  private:
    void write_header(std::ostream& out) const {
        const std::size_t count = order_.size();
        out << "ply\nformat binary_little_endian 1.0\n"
            << ply_comments(model_) << "element chunk " << (count + chunk_size - 1) / chunk_size << "\n";
        for (const char* name : chunk_properties) out << "property float " << name << "\n";
        out << "element vertex " << count << "\n";
        for (const char* name : vertex_properties) out << "property uint " << name << "\n";
        if (coefficients_ > 0) out << "element sh " << count << "\n";
        for (std::size_t k = 0; k < 3 * coefficients_; ++k) out << "property uchar f_rest_" << k << "\n";
        out << "end_header\n";
    }

    std::vector<chunk> chunks_of_model() const {
        std::vector<chunk> chunks((order_.size() + chunk_size - 1) / chunk_size);
        for (std::size_t i = 0; i < order_.size(); ++i) {
            chunk& c = chunks[i / chunk_size];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t place = 3 * std::size_t{order_[i]} + k;
                c.position.include(k, model_.mean[place]);
                c.scale.include(k, clamped_log_scale(model_.log_scale[place]));
                c.color.include(k, color_of(model_.sh_constant[place]));
            }
        }
        return chunks;
    }

    packed_vertex pack(const chunk& c, std::size_t i) const {
        std::array<float, 3> scale{};
        std::uint32_t color = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            scale[k] = clamped_log_scale(model_.log_scale[3 * i + k]);
            color = color << 8 | c.color.quantized(k, color_of(model_.sh_constant[3 * i + k]), 255);
        }
        return {pack_111011(c.position, &model_.mean[3 * i]), pack_rotation(&model_.quaternion[4 * i]),
                pack_111011(c.scale, scale.data()), color << 8 | opacity_to_byte(model_.opacity[i])};
    }

    /// Writes the coefficients of each Gaussian channel by channel.
    void write_sh(std::ostream& out) const {
        const auto width = static_cast<std::size_t>(model_.rest_width());
        std::vector<std::uint8_t> row(3 * coefficients_);
        for (const std::size_t i : order_) {
            const float* const rest = &model_.sh_rest[i * width];
            for (std::size_t channel = 0; channel < 3; ++channel)
                for (std::size_t k = 0; k < coefficients_; ++k)
                    row[channel * coefficients_ + k] = pack_sh(rest[3 * k + channel]);
            write_raw(out, row.data(), row.size());
        }
    }

    const gaussians& model_;
    std::vector<std::uint32_t> order_;
    std::size_t coefficients_;  ///< per channel, above degree 0
};

class compressed_input {
  public:
    explicit compressed_input(const std::filesystem::path& file) : file_(file) {}

    gaussians read() {
        gaussians comments;
        const ply_header header(file_, elements,
                                [&](std::string_view line) { read_ply_comment(line, file_.name, comments); });
        const ply_element& vertex = element(header, "vertex");
        const ply_element& chunk = element(header, "chunk");
        const ply_element* const sh = header.find("sh");
        const int sh_degree = sh ? degree(sh->stride) : 0;
        require_properties(header, chunk, chunk_properties, ply_scalar::float32);
        require_properties(header, vertex, vertex_properties, ply_scalar::uint32);
        if (sh) require_sh_properties(header, *sh);
        header.require_size();  // before memory is allocated for the count in the header
        if (chunk.count != (vertex.count + chunk_size - 1) / chunk_size)
            fail("it has " + std::to_string(chunk.count) + " chunks of 256 for " +
                 std::to_string(vertex.count) + " vertices");
        if (sh_degree > 0 && sh->count != vertex.count)
            fail("it has " + std::to_string(sh->count) + " rows 'sh' for " + std::to_string(vertex.count) +
                 " vertices");
        model_ = sized_model(static_cast<std::size_t>(vertex.count), sh_degree);
        model_.antialiased = comments.antialiased;
        model_.sky = std::move(comments.sky);
        read_vertices(header, chunk, vertex);
        if (sh_degree > 0) read_sh(header, *sh);
        return std::move(model_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw error(file_.name + ": " + what); }

    const ply_element& element(const ply_header& header, std::string_view name) const {
        const ply_element* const found = header.find(name);
        if (!found) fail("it has no element '" + std::string(name) + "'");
        return *found;
    }

    int degree(std::size_t properties) const {
        for (int degree = 0; degree <= 3; ++degree)
            if (properties == static_cast<std::size_t>(3 * (sh_coefficients(degree) - 1))) return degree;
        fail("its rows 'sh' have " + std::to_string(properties) +
             " bytes, but SH degrees 1 to 3 have 9, 24 or 45");
    }

    /// Throws `error` unless the rows of an element are exactly these properties in this order.
    template <std::size_t N>
    void require_properties(const ply_header& header, const ply_element& rows,
                            const std::array<const char*, N>& names, ply_scalar type) const {
        const std::span<const ply_property> found = header.properties(rows);
        for (std::size_t i = 0; i < N; ++i)
            if (i >= found.size() || found[i].name != names[i] || found[i].type != type)
                fail("property " + std::to_string(i) + " of its element '" + std::string(rows.name) +
                     "' is not " + names[i]);
        if (found.size() != N) fail("its element '" + std::string(rows.name) + "' has unknown properties");
    }

    void require_sh_properties(const ply_header& header, const ply_element& rows) const {
        const std::span<const ply_property> found = header.properties(rows);
        for (std::size_t k = 0; k < found.size(); ++k)
            if (found[k].name != "f_rest_" + std::to_string(k) || found[k].type != ply_scalar::uint8)
                fail("property " + std::to_string(k) + " of its element 'sh' is not f_rest_" +
                     std::to_string(k));
    }

    void seek(std::uint64_t offset) { file_.in.seekg(static_cast<std::streamoff>(offset)); }

    template <class T>
    void read_raw(T* values, std::size_t count) {
        file_.in.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
        if (!file_.in) throw error("cannot read " + file_.name);
    }

    void read_vertices(const ply_header& header, const ply_element& chunk_rows, const ply_element& rows) {
        std::array<packed_vertex, chunk_size> packed;
        for (std::size_t first = 0; first < model_.count(); first += chunk_size) {
            seek(header.offset(chunk_rows) + first / chunk_size * sizeof(chunk));
            chunk c;
            read_raw(&c, 1);
            for (const range& r : {c.position, c.scale, c.color})
                if (!std::ranges::all_of(r.bounds, [](float x) { return std::isfinite(x); }))
                    fail("a range of chunk " + std::to_string(first / chunk_size) + " is not finite");
            const std::size_t size = std::min(chunk_size, model_.count() - first);
            seek(header.offset(rows) + first * sizeof(packed_vertex));
            read_raw(packed.data(), size);
            for (std::size_t i = 0; i < size; ++i) unpack(c, packed[i], first + i);
        }
    }

    void unpack(const chunk& c, const packed_vertex& packed, std::size_t i) {
        unpack_111011(c.position, packed[0], &model_.mean[3 * i]);
        unpack_rotation(packed[1], &model_.quaternion[4 * i]);
        unpack_111011(c.scale, packed[2], &model_.log_scale[3 * i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const float color = c.color.value(k, packed[3] >> (24 - 8 * k) & 255, 255);
            const float sh = sh_from_color(color);
            if (!std::isfinite(sh)) fail("the color of Gaussian " + std::to_string(i) + " is not finite");
            model_.sh_constant[3 * i + k] = sh;
        }
        model_.opacity[i] = byte_to_opacity(static_cast<std::uint8_t>(packed[3] & 255));
    }

    void read_sh(const ply_header& header, const ply_element& rows) {
        const auto width = static_cast<std::size_t>(model_.rest_width());
        std::array<std::uint8_t, 45> row;
        seek(header.offset(rows));
        for (std::size_t i = 0; i < model_.count(); ++i) {
            read_raw(row.data(), width);
            float* const rest = &model_.sh_rest[i * width];
            for (std::size_t k = 0; k < width; ++k)
                rest[3 * (k % (width / 3)) + k / (width / 3)] = unpack_sh(row[k]);
        }
    }

    opened_file file_;
    gaussians model_;
};

void write_compressed_ply_file(const std::filesystem::path& file, const gaussians& model,
                               const write_options& options) {
    atomic_file_write(file, [&](std::ostream& out) { write_compressed_ply(out, file, model, options); });
}

gaussians read_compressed_ply(const std::filesystem::path& file) { return compressed_input(file).read(); }

constexpr std::string_view endings[] = {".compressed.ply"};

}  // namespace

void write_compressed_ply(std::ostream& out, const std::filesystem::path& file, const gaussians& model,
                          const write_options& options) {
    const int sh_degree = std::min(model.sh_degree, options.max_sh_degree);
    require_writable(file, model, sh_degree);
    require_finite_sky(file, model);
    compressed_output(model, sh_degree).write(out);
}

constinit const writer compressed_ply_writer{"compressed PLY", endings, write_compressed_ply_file,
                                             read_compressed_ply};

}  // namespace gs
