// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../jpeg_planes.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "../../core/large_memory.hpp"
#include "codec.hpp"
#include "jpeg_reader.hpp"

namespace gs {
namespace {

std::size_t whole_blocks(std::size_t samples) { return (samples + 7) / 8 * 8; }
std::size_t half(std::size_t samples) { return (samples + 1) / 2; }

/// Sizes of the planes.
struct plane_sizes {
    std::size_t color_width, color_height;
    std::size_t row_bytes, rows;              ///< of brightness
    std::size_t color_row_bytes, color_rows;  ///< of each color

    explicit plane_sizes(const jpeg_planes& of)
        : color_width(half(static_cast<std::size_t>(of.width))),
          color_height(of.has_half_height_colors ? half(static_cast<std::size_t>(of.height))
                                                 : static_cast<std::size_t>(of.height)),
          row_bytes(whole_blocks(static_cast<std::size_t>(of.width))),
          rows(whole_blocks(static_cast<std::size_t>(of.height))),
          color_row_bytes(whole_blocks(color_width)),
          color_rows(whole_blocks(color_height)) {}

    std::size_t color_plane_bytes() const { return color_row_bytes * color_rows; }
    std::size_t color_plane(std::size_t color) const {
        return row_bytes * rows + color * color_plane_bytes();
    }
};

/// Reads the header. Sets all but the samples, and returns whether there are samples for `jpeg_planes`.
bool read_header(const image_file& file, jpeg_reader& reader, jpeg_planes& planes) {
    if (!reader.read_header(file.rewound())) refuse_jpeg(file, reader);
    const image_size size = reader.size();
    file.check_size(size);
    file.check_density(size);
    planes.width = static_cast<int>(size.width);
    planes.height = static_cast<int>(size.height);
    // libjpeg does not interpolate the colors of images as narrow as four pixels.
    if (!reader.has_half_width_colors() || planes.width <= 4) return false;
    planes.has_half_height_colors = reader.has_half_height_colors();
    return true;
}

using short_row = std::vector<std::int16_t>;

/// Interpolates a row of color to twice its width, less 128. `far` is the next row but `near`. `sums`
/// has one value more on both sides.
void interpolate(const std::uint8_t* near, const std::uint8_t* far, bool between_rows, short_row& sums,
                 short_row& result) {
    const std::size_t n = sums.size() - 2;
    std::int16_t* const s = sums.data() + 1;
    std::int16_t* const to = result.data();
    for (std::size_t i = 0; i < n; ++i)
        s[i] = static_cast<std::int16_t>(between_rows ? 3 * near[i] + far[i] : near[i]);
    s[-1] = s[0];
    s[n] = s[n - 1];
    const int shift = between_rows ? 4 : 2, left = between_rows ? 8 : 1, right = between_rows ? 7 : 2;
    for (std::size_t i = 0; i < n; ++i) {
        to[2 * i] = static_cast<std::int16_t>(((3 * s[i] + s[i - 1] + left) >> shift) - 128);
        to[2 * i + 1] = static_cast<std::int16_t>(((3 * s[i] + s[i + 1] + right) >> shift) - 128);
    }
}

std::uint32_t clamped(int value) { return static_cast<std::uint32_t>(std::clamp(value, 0, 255)); }

/// Products of 16 bits, rounded and divided by 2^16. Coefficients are less whole numbers, to fit.
void convert(const std::uint8_t* brightness, const std::int16_t* blue, const std::int16_t* red,
             std::size_t pixels, std::uint8_t* rgba) {
    constexpr std::int16_t red_of_red = 91881 - 65536;      // 1.402 - 1
    constexpr std::int16_t blue_of_blue = 116130 - 131072;  // 1.772 - 2
    constexpr std::int16_t green_of_blue = -22554;          // -.34414
    constexpr std::int16_t green_of_red = 65536 - 46802;    // 1 - .71414
    constexpr int rounding = 32768;
    for (std::size_t x = 0; x < pixels; ++x) {
        const int y = brightness[x];
        const std::int16_t cb = blue[x], cr = red[x];
        const int r = y + cr + ((red_of_red * cr + rounding) >> 16);
        const int g = y - cr + ((green_of_blue * cb + green_of_red * cr + rounding) >> 16);
        const int b = y + 2 * cb + ((blue_of_blue * cb + rounding) >> 16);
        const std::uint32_t pixel =
            clamped(r) | clamped(g) << 8 | clamped(b) << 16 | std::uint32_t{0xFF000000};
        std::memcpy(rgba + 4 * x, &pixel, 4);
    }
}

}  // namespace

std::size_t jpeg_planes::bytes() const { return plane_sizes(*this).color_plane(2); }

std::size_t jpeg_plane_bytes(const std::filesystem::path& path) {
    const image_file file(path);
    if (&codec_of(file) != &jpeg_codec) return 0;
    jpeg_reader reader;
    jpeg_planes planes;
    return read_header(file, reader, planes) ? planes.bytes() : 0;
}

void read_jpeg_planes(const std::filesystem::path& path, jpeg_planes& planes) {
    const image_file file(path);
    jpeg_reader reader;
    if (!read_header(file, reader, planes)) file.refuse("its samples have changed");
    resize_for_image(planes.samples, planes.bytes());
    const plane_sizes sizes(planes);
    std::uint8_t* const all = planes.samples.data();
    if (!reader.read_planes({{{all, sizes.row_bytes, sizes.rows},
                              {all + sizes.color_plane(0), sizes.color_row_bytes, sizes.color_rows},
                              {all + sizes.color_plane(1), sizes.color_row_bytes, sizes.color_rows}}}))
        refuse_jpeg(file, reader);
}

void to_rgba(const jpeg_planes& planes, std::uint8_t* rgba) {
    const plane_sizes sizes(planes);
    const std::uint8_t* const all = planes.samples.data();
    const auto width = static_cast<std::size_t>(planes.width);
    short_row sums(sizes.color_width + 2);
    std::array<short_row, 2> colors;
    for (short_row& c : colors) c.resize(2 * sizes.color_width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(planes.height); ++y) {
        const std::size_t near = planes.has_half_height_colors ? y / 2 : y;
        const std::size_t far =
            y % 2 == 0 ? (near == 0 ? 0 : near - 1) : std::min(near + 1, sizes.color_height - 1);
        for (std::size_t c = 0; c < 2; ++c) {
            const std::uint8_t* const plane = all + sizes.color_plane(c);
            interpolate(plane + near * sizes.color_row_bytes, plane + far * sizes.color_row_bytes,
                        planes.has_half_height_colors, sums, colors[c]);
        }
        convert(all + y * sizes.row_bytes, colors[0].data(), colors[1].data(), width, rgba + 4 * width * y);
    }
}

}  // namespace gs
