// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "codec.hpp"

// jpeglib.h requires FILE and size_t to be declared.
#include <jpeglib.h>
// jerror.h depends on jpeglib.h.
#include <jerror.h>

namespace gs {
namespace {

// Each scan of a progressive JPEG visits all pixels, so a small file could take a long time. This
// is the largest number of scans that cjpeg writes.
constexpr int most_scans = 100;

constexpr int exif_marker = JPEG_APP0 + 1;  // XMP data have the same marker

// libjpeg reports errors by longjmp. So each function that calls it has no objects with
// destructors in its frame; its callers own all resources.

struct jpeg_errors {
    jpeg_error_mgr manager{};  ///< first, so that a pointer to it is a pointer to the struct
    std::jmp_buf escape{};
    std::array<char, JMSG_LENGTH_MAX> message{};
    bool no_pixels = false;
};

jpeg_errors& errors_of(j_common_ptr jpeg) { return *reinterpret_cast<jpeg_errors*>(jpeg->err); }

[[noreturn]] void leave_jpeg(j_common_ptr jpeg) {
    jpeg_errors& errors = errors_of(jpeg);
    jpeg->err->format_message(jpeg, errors.message.data());
    errors.no_pixels = jpeg->err->msg_code == JERR_EMPTY_IMAGE;
    std::longjmp(errors.escape, 1);
}

bool means_lost_pixels(int message_code) {
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
void heed_jpeg_warning(j_common_ptr jpeg, int level) {
    if (level < 0 && means_lost_pixels(jpeg->err->msg_code)) leave_jpeg(jpeg);
}

void count_jpeg_scans(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= most_scans) return;
    std::snprintf(errors_of(jpeg).message.data(), JMSG_LENGTH_MAX, "more than %d scans", most_scans);
    std::longjmp(errors_of(jpeg).escape, 1);
}

void print_no_jpeg_message(j_common_ptr) {}

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

    /// Precondition: `pixels` has space for width * height * 4 bytes.
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

    std::string failure() const { return errors_.message.data(); }
    bool found_no_pixels() const { return errors_.no_pixels; }

  private:
    jpeg_decompress_struct jpeg_{};
    jpeg_errors errors_;
    jpeg_progress_mgr progress_{};
};

[[noreturn]] void refuse_jpeg(const image_file& file, const jpeg_reader& reader) {
    if (reader.found_no_pixels()) file.refuse("it has no pixels");
    file.refuse("it is damaged or truncated (" + reader.failure() + ")");
}

bool is_jpeg(std::span<const std::uint8_t> start) {
    return start.size() >= 2 && start[0] == 0xFF && start[1] == 0xD8;
}

image_size read_jpeg_size(const image_file& file) {
    jpeg_reader reader;
    if (!reader.read_header(file.rewound())) refuse_jpeg(file, reader);
    return reader.size();
}

orientation read_jpeg_orientation(const image_file& file) {
    jpeg_reader reader;
    if (!reader.read_header(file.rewound())) refuse_jpeg(file, reader);
    return orientation_in_exif(reader.exif());
}

/// Each ink removes its share of the light, without the color profile of a printer.
void cmyk_to_rgba(image& pixels, bool inverted) {
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
        std::uint8_t* const pixel = &pixels.rgba[i];
        const auto light = [&](std::size_t ink) { return inverted ? pixel[ink] : 255U - pixel[ink]; };
        const unsigned black = light(3);
        for (std::size_t ink = 0; ink < 3; ++ink)
            pixel[ink] = static_cast<std::uint8_t>((light(ink) * black + 127) / 255);
        pixel[3] = 255;
    }
}

void read_jpeg(const image_file& file, image& pixels) {
    jpeg_reader reader;
    if (!reader.read_header(file.rewound())) refuse_jpeg(file, reader);
    file.check_decoded_size(reader.size(), size_of(pixels));
    if (!reader.read_rows(pixels.rgba.data())) refuse_jpeg(file, reader);
    if (reader.is_cmyk()) cmyk_to_rgba(pixels, reader.has_inverted_cmyk());
}

constexpr std::string_view jpeg_endings[] = {".jpg", ".jpeg"};

}  // namespace

extern constinit const image_codec jpeg_codec{"JPEG",         jpeg_endings,          is_jpeg,
                                              read_jpeg_size, read_jpeg_orientation, read_jpeg};

}  // namespace gs
