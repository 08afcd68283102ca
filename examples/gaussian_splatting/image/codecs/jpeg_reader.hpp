// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "image_file.hpp"

// jpeglib.h requires FILE and size_t to be declared.
#include <jpeglib.h>
// jerror.h depends on jpeglib.h.
#include <jerror.h>

namespace gs {

// Each scan of a progressive JPEG visits all pixels, so a small file could take a long time. This
// is the largest number of scans that cjpeg writes.
inline constexpr int most_scans = 100;

inline constexpr int exif_marker = JPEG_APP0 + 1;  // XMP data have the same marker

// libjpeg reports errors by longjmp. So each function that calls it has no objects with
// destructors in its frame; its callers own all resources.

struct jpeg_errors {
    jpeg_error_mgr manager{};  ///< first, so that a pointer to it is a pointer to the struct
    std::jmp_buf escape{};
    std::array<char, JMSG_LENGTH_MAX> message{};
    bool no_pixels = false;
};

inline jpeg_errors& errors_of(j_common_ptr jpeg) { return *reinterpret_cast<jpeg_errors*>(jpeg->err); }

[[noreturn]] inline void leave_jpeg(j_common_ptr jpeg) {
    jpeg_errors& errors = errors_of(jpeg);
    jpeg->err->format_message(jpeg, errors.message.data());
    errors.no_pixels = jpeg->err->msg_code == JERR_EMPTY_IMAGE;
    std::longjmp(errors.escape, 1);
}

inline bool means_lost_pixels(int message_code) {
    switch (message_code) {
        case JWRN_JPEG_EOF:
        case JWRN_HIT_MARKER:
        case JWRN_HUFF_BAD_CODE:
        case JWRN_ARITH_BAD_CODE:
        case JWRN_MUST_RESYNC:
            return true;
        default:
            return false;  // stray bytes or odd marker values: the pixels are complete
    }
}

// Treats lost data as an error. By default, libjpeg continues and paints the rest gray.
inline void heed_jpeg_warning(j_common_ptr jpeg, int level) {
    if (level < 0 && means_lost_pixels(jpeg->err->msg_code)) leave_jpeg(jpeg);
}

inline void count_jpeg_scans(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= most_scans) return;
    std::snprintf(errors_of(jpeg).message.data(), JMSG_LENGTH_MAX, "more than %d scans", most_scans);
    std::longjmp(errors_of(jpeg).escape, 1);
}

inline void print_no_jpeg_message(j_common_ptr) {}

/// Reads a JPEG through libjpeg. Functions that read return false on errors.
class jpeg_reader {
  public:
    jpeg_reader() {
        jpeg_.err = jpeg_std_error(&errors_.manager);
        errors_.manager.error_exit = leave_jpeg;
        errors_.manager.emit_message = heed_jpeg_warning;
        errors_.manager.output_message = print_no_jpeg_message;
        progress_.progress_monitor = count_jpeg_scans;
    }
    ~jpeg_reader() { jpeg_destroy_decompress(&jpeg_); }
    jpeg_reader(const jpeg_reader&) = delete;
    jpeg_reader& operator=(const jpeg_reader&) = delete;

    bool read_header(std::FILE* file) {
        if (setjmp(errors_.escape)) return false;
        jpeg_create_decompress(&jpeg_);
        jpeg_.progress = &progress_;
        jpeg_stdio_src(&jpeg_, file);
        jpeg_save_markers(&jpeg_, exif_marker, 0xFFFF);
        jpeg_read_header(&jpeg_, TRUE);
        return true;
    }

    image_size size() const { return {jpeg_.image_width, jpeg_.image_height}; }

    std::span<const std::uint8_t> exif() const {
        constexpr std::string_view signature("Exif\0\0", 6);
        for (jpeg_saved_marker_ptr one = jpeg_.marker_list; one; one = one->next)
            if (one->data_length > signature.size() &&
                std::memcmp(one->data, signature.data(), signature.size()) == 0)
                return {one->data, one->data_length};
        return {};
    }

    /// Whether the rows that `read_rows` reads are CMYK instead of RGBA.
    bool is_cmyk() const { return jpeg_.num_components == 4; }
    /// Whether CMYK values are amounts of light instead of ink, as Adobe's programs write them.
    bool has_inverted_cmyk() const { return jpeg_.saw_Adobe_marker; }

    /// Reads all pixels. Precondition: `pixels` has space for width * height * 4 bytes.
    bool read_rows(std::uint8_t* pixels) {
        if (setjmp(errors_.escape)) return false;
        jpeg_.out_color_space = is_cmyk() ? JCS_CMYK : JCS_EXT_RGBA;
        jpeg_start_decompress(&jpeg_);
        while (jpeg_.output_scanline < jpeg_.output_height) {
            JSAMPROW row = pixels + std::size_t{4} * jpeg_.output_width * jpeg_.output_scanline;
            jpeg_read_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_decompress(&jpeg_);
        return true;
    }

    /// Whether `read_planes` can read the samples: brightness, and two colors of half the width.
    bool has_half_width_colors() const {
        const auto samples = [&](int component, int across, int down) {
            const jpeg_component_info& info = jpeg_.comp_info[component];
            return info.h_samp_factor == across && info.v_samp_factor == down;
        };
        return jpeg_.num_components == 3 && jpeg_.jpeg_color_space == JCS_YCbCr &&
               (samples(0, 2, 1) || samples(0, 2, 2)) && samples(1, 1, 1) && samples(2, 1, 1);
    }
    bool has_half_height_colors() const { return jpeg_.comp_info[0].v_samp_factor == 2; }

    /// A plane of samples: rows of whole blocks of 8 x 8 samples.
    struct plane {
        std::uint8_t* samples;
        std::size_t row_bytes, rows;
    };
    /// Precondition: the planes have space for all blocks.
    bool read_planes(const std::array<plane, 3>& planes) {
        if (setjmp(errors_.escape)) return false;
        jpeg_.raw_data_out = TRUE;
        jpeg_start_decompress(&jpeg_);
        const JDIMENSION lines = DCTSIZE * static_cast<JDIMENSION>(jpeg_.max_v_samp_factor);
        std::array<std::array<JSAMPROW, 2 * DCTSIZE>, 3> rows;
        std::array<JSAMPARRAY, 3> row_lists;
        for (std::size_t p = 0; p < 3; ++p) row_lists[p] = rows[p].data();
        while (jpeg_.output_scanline < jpeg_.output_height) {
            for (std::size_t p = 0; p < 3; ++p) {
                const std::size_t down = p == 0 ? 1 : static_cast<std::size_t>(jpeg_.max_v_samp_factor);
                for (std::size_t i = 0; i < lines / down; ++i) {
                    // libjpeg does not write to rows beyond the last block.
                    const std::size_t row = std::min(jpeg_.output_scanline / down + i, planes[p].rows - 1);
                    rows[p][i] = planes[p].samples + planes[p].row_bytes * row;
                }
            }
            jpeg_read_raw_data(&jpeg_, row_lists.data(), lines);
        }
        jpeg_finish_decompress(&jpeg_);
        return true;
    }

    std::string failure() const { return errors_.message.data(); }
    bool found_no_pixels() const { return errors_.no_pixels; }

  private:
    jpeg_decompress_struct jpeg_{};
    jpeg_errors errors_;
    jpeg_progress_mgr progress_{};
};

[[noreturn]] inline void refuse_jpeg(const image_file& file, const jpeg_reader& reader) {
    if (reader.found_no_pixels()) file.refuse("it has no pixels");
    file.refuse("it is damaged or truncated (" + reader.failure() + ")");
}

}  // namespace gs
