// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <vector>

// jpeglib.h requires FILE and size_t to be declared.
#include <jpeglib.h>

namespace gs_test {

struct jpeg_kind {
    J_COLOR_SPACE samples;  ///< color space of the samples
    bool progressive = false;
    bool adobe_marker = false;  ///< only for four channels
    bool ycck = false;          ///< converts CMYK to YCCK
    int pixels_across = 1;      ///< pixels per value of color, along rows
    int pixels_down = 1;        ///< and along columns
};

/// Writes a JPEG of the highest quality. Without subsampling, only rounding changes the pixels.
inline void write_jpeg(const std::filesystem::path& file, int width, int height, const jpeg_kind& kind,
                       std::vector<std::uint8_t> samples) {
    std::FILE* out = std::fopen(file.c_str(), "wb");
    jpeg_error_mgr errors;
    jpeg_compress_struct jpeg{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, out);
    jpeg.image_width = static_cast<JDIMENSION>(width);
    jpeg.image_height = static_cast<JDIMENSION>(height);
    jpeg.input_components = kind.samples == JCS_GRAYSCALE ? 1 : kind.samples == JCS_RGB ? 3 : 4;
    jpeg.in_color_space = kind.samples;
    jpeg_set_defaults(&jpeg);
    if (kind.ycck) jpeg_set_colorspace(&jpeg, JCS_YCCK);
    if (jpeg.input_components == 4) jpeg.write_Adobe_marker = kind.adobe_marker ? TRUE : FALSE;
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (kind.progressive) jpeg_simple_progression(&jpeg);
    jpeg.comp_info[0].h_samp_factor = kind.pixels_across;
    jpeg.comp_info[0].v_samp_factor = kind.pixels_down;
    jpeg_start_compress(&jpeg, TRUE);
    const std::size_t row_bytes = static_cast<std::size_t>(width * jpeg.input_components);
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW row = samples.data() + row_bytes * jpeg.next_scanline;
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::fclose(out);
}

/// Samples in which neighbors differ little, as in a photo.
inline std::vector<std::uint8_t> smooth_samples(int width, int height, int channels) {
    std::vector<std::uint8_t> samples;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < channels; ++channel)
                samples.push_back(static_cast<std::uint8_t>(
                    std::lround(128 + 90 * std::sin(0.11 * x + 0.07 * y + channel))));
    return samples;
}

}  // namespace gs_test
