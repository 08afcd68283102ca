// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "spz.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../../core/parallel.hpp"
#include "../axes.hpp"
#include "../quantize.hpp"
#include "../require_writable.hpp"
#include "../smallest_three.hpp"
#include "spz_container.hpp"

namespace gs {
namespace {

constexpr int usual_fractional_bits = 12, most_fractional_bits = 24;
constexpr double color_scale = 0.15;  ///< bytes per SH coefficient, divided by 255
/// Step of SH bytes. With the 8 and 16 that other programs use, glossy surfaces lose their reflections.
constexpr int sh_step = 2;

/// Returns the number of fractional bits. Positions have 12, as other programs write them, unless
/// they need more bits before the point, or the model is so small that it would have less than 2^16
/// steps.
int fractional_bits_of(const std::filesystem::path& file, const gaussians& model) {
    float largest = 0;
    for (const float x : model.mean) largest = std::max(largest, std::abs(x));
    if (largest == 0) return usual_fractional_bits;
    const int integral_bits = std::ilogb(largest) + 1;
    if (integral_bits > 23)
        throw error("cannot write " + file.string() + ": the position " + std::to_string(largest) +
                    " is beyond the range of SPZ files, which ends at 2^23; use another format or --crop");
    return std::min(
        {std::max(usual_fractional_bits, 16 - integral_bits), 23 - integral_bits, most_fractional_bits});
}

void pack_position(const float* position, int fractional_bits, std::uint8_t* bytes) {
    constexpr double most = (1 << 23) - 1;
    for (std::size_t k = 0; k < 3; ++k) {
        const double scaled = std::ldexp(double(turn_about_x::position[k] * position[k]), fractional_bits);
        const auto fixed = static_cast<std::int32_t>(std::lround(std::clamp(scaled, -most, most)));
        for (int b = 0; b < 3; ++b) *bytes++ = static_cast<std::uint8_t>(fixed >> (8 * b) & 255);
    }
}

void unpack_position(const std::uint8_t* bytes, int fractional_bits, float* position) {
    for (std::size_t k = 0; k < 3; ++k, bytes += 3) {
        std::int32_t fixed = bytes[0] | bytes[1] << 8 | bytes[2] << 16;
        if (fixed >= 1 << 23) fixed -= 1 << 24;
        position[k] = turn_about_x::position[k] * static_cast<float>(std::ldexp(fixed, -fractional_bits));
    }
}

/// The components in the file are x y z w. Each has a sign bit and 9 bits.
void pack_rotation(const float* q, std::uint8_t* bytes) {
    const auto turned = [&](std::size_t k) { return double(turn_about_x::rotation[k] * q[k]); };
    const smallest_three three = smallest_three_of({turned(1), turned(2), turned(3), turned(0)});
    auto packed = static_cast<std::uint32_t>(three.largest);
    for (const double x : three.others)
        packed = packed << 10 | (x < 0 ? 1U << 9 : 0) | to_unorm(std::abs(x), 511);
    for (int b = 0; b < 4; ++b) bytes[b] = static_cast<std::uint8_t>(packed >> (8 * b) & 255);
}

void store_rotation(const std::array<double, 4>& xyzw, float* q) {
    for (std::size_t k = 0; k < 4; ++k)
        q[k] = turn_about_x::rotation[k] * static_cast<float>(xyzw[(k + 3) % 4]);
}

void unpack_rotation(const std::uint8_t* bytes, float* q) {
    std::uint32_t packed = 0;
    for (int b = 0; b < 4; ++b) packed |= std::uint32_t{bytes[b]} << (8 * b);
    smallest_three three{packed >> 30, {}};
    for (std::size_t k = 3; k-- > 0; packed >>= 10)
        three.others[k] = (packed >> 9 & 1 ? -1.0 : 1.0) * (packed & 511) / 511;
    store_rotation(quaternion_of(three), q);
}

/// In version 2, the file has x y z as bytes. w is positive.
void unpack_rotation_of_version_2(const std::uint8_t* bytes, float* q) {
    std::array<double, 4> xyzw{};
    double square = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        xyzw[k] = bytes[k] / 127.5 - 1;
        square -= xyzw[k] * xyzw[k];
    }
    xyzw[3] = std::sqrt(std::max(square, 0.0));
    store_rotation(xyzw, q);
}

/// Returns the byte of an SH coefficient, rounded to a multiple of `sh_step`, so that it needs fewer
/// bits.
std::uint8_t pack_sh(float x) { return to_byte(std::round((128 * double(x) + 128) / sh_step) * sh_step); }

spz_content pack(const std::filesystem::path& file, const gaussians& model, int sh_degree, int version) {
    spz_content content{.version = version,
                        .count = model.count(),
                        .sh_degree = sh_degree,
                        .fractional_bits = fractional_bits_of(file, model),
                        .antialiased = model.antialiased};
    for (std::size_t i = 0; i < spz_attributes; ++i)
        assign_zeros(content.streams[i], model.count() * content.width(static_cast<spz_attribute>(i)));
    using enum spz_attribute;
    const auto sh_model = static_cast<std::size_t>(model.rest_width()), sh_file = content.width(sh);
    for_each_index_in_parallel(model.count(), [&](std::size_t i) {
        pack_position(&model.mean[3 * i], content.fractional_bits, &content[position][9 * i]);
        pack_rotation(&model.quaternion[4 * i], &content[rotation][4 * i]);
        content[alpha][i] = opacity_to_byte(model.opacity[i]);
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
            content[color][k] = to_byte(255 * (0.5 + color_scale * double(model.sh_constant[k])));
            content[scale][k] = to_byte(16 * (double(model.log_scale[k]) + 10));
        }
        for (std::size_t k = 0; k < sh_file; ++k)
            content[sh][i * sh_file + k] = pack_sh(turn_about_x::sh[k / 3] * model.sh_rest[i * sh_model + k]);
    });
    return content;
}

void write_spz(const std::filesystem::path& file, const gaussians& model, const write_options& options) {
    const int sh_degree = std::min(model.sh_degree, options.max_sh_degree);
    require_writable(file, model, sh_degree);
    if (model.count() > std::numeric_limits<std::uint32_t>::max())
        throw error("cannot write " + file.string() + ": an SPZ file has at most 2^32 - 1 Gaussians");
    const spz_content content = pack(file, model, sh_degree, options.spz_version);
    atomic_file_write(file, [&](std::ostream& out) { write_spz_container(out, content); });
}

gaussians read_spz(const std::filesystem::path& file) {
    opened_file opened(file);
    spz_content content = read_spz_container(opened);
    gaussians model = sized_model(content.count, std::min(content.sh_degree, 3));
    model.antialiased = content.antialiased;
    using enum spz_attribute;
    const auto sh_model = static_cast<std::size_t>(model.rest_width()), sh_file = content.width(sh);
    for_each_index_in_parallel(model.count(), [&](std::size_t i) {
        unpack_position(&content[position][9 * i], content.fractional_bits, &model.mean[3 * i]);
        if (content.version == 2)
            unpack_rotation_of_version_2(&content[rotation][3 * i], &model.quaternion[4 * i]);
        else
            unpack_rotation(&content[rotation][4 * i], &model.quaternion[4 * i]);
        model.opacity[i] = byte_to_opacity(content[alpha][i]);
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
            model.sh_constant[k] = static_cast<float>((content[color][k] / 255.0 - 0.5) / color_scale);
            model.log_scale[k] = static_cast<float>(content[scale][k] / 16.0 - 10);
        }
        for (std::size_t k = 0; k < sh_model; ++k)
            model.sh_rest[i * sh_model + k] =
                turn_about_x::sh[k / 3] * static_cast<float>(content[sh][i * sh_file + k] - 128) / 128;
    });
    return model;
}

constexpr std::string_view endings[] = {".spz"};

}  // namespace

constinit const writer spz_writer{
    .name = "SPZ", .endings = endings, .write = write_spz, .read = read_spz, .holds_sky = false};

}  // namespace gs
