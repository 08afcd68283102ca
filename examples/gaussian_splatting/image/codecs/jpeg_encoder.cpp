// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "../../core/error.hpp"
#include "../image.hpp"

// jpeglib.h requires FILE and size_t to be declared.
#include <jpeglib.h>

namespace gs {
namespace {

struct jpeg_write_errors {
    jpeg_error_mgr manager{};  ///< first, so that a pointer to it is a pointer to the struct
    std::jmp_buf escape{};
    std::array<char, JMSG_LENGTH_MAX> message{};
};

[[noreturn]] void leave_jpeg_writer(j_common_ptr jpeg) {
    auto& errors = *reinterpret_cast<jpeg_write_errors*>(jpeg->err);
    jpeg->err->format_message(jpeg, errors.message.data());
    std::longjmp(errors.escape, 1);
}

/// libjpeg reports errors by longjmp, so `compress` has no objects with destructors in its frame.
class jpeg_writer {
  public:
    jpeg_writer() {
        jpeg_.err = jpeg_std_error(&errors_.manager);
        errors_.manager.error_exit = leave_jpeg_writer;
    }
    ~jpeg_writer() {
        jpeg_destroy_compress(&jpeg_);
        std::free(bytes_);
    }
    jpeg_writer(const jpeg_writer&) = delete;
    jpeg_writer& operator=(const jpeg_writer&) = delete;

    bool compress(int width, int height, const std::uint8_t* rgb, int quality) {
        if (setjmp(errors_.escape)) return false;
        jpeg_create_compress(&jpeg_);
        jpeg_mem_dest(&jpeg_, &bytes_, &size_);
        jpeg_.image_width = static_cast<JDIMENSION>(width);
        jpeg_.image_height = static_cast<JDIMENSION>(height);
        jpeg_.input_components = 3;
        jpeg_.in_color_space = JCS_RGB;
        jpeg_set_defaults(&jpeg_);
        jpeg_set_quality(&jpeg_, quality, TRUE);
        jpeg_start_compress(&jpeg_, TRUE);
        while (jpeg_.next_scanline < jpeg_.image_height) {
            const std::size_t start = std::size_t{3} * jpeg_.image_width * jpeg_.next_scanline;
            JSAMPROW row = const_cast<JSAMPROW>(rgb + start);  // libjpeg only reads it
            jpeg_write_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_compress(&jpeg_);
        return true;
    }

    std::vector<std::uint8_t> bytes() const { return {bytes_, bytes_ + size_}; }
    std::string failure() const { return errors_.message.data(); }

  private:
    jpeg_compress_struct jpeg_{};
    jpeg_write_errors errors_;
    unsigned char* bytes_ = nullptr;
    unsigned long size_ = 0;
};

}  // namespace

std::vector<std::uint8_t> encode_jpeg(int width, int height, const std::vector<std::uint8_t>& rgb,
                                      int quality) {
    jpeg_writer writer;
    if (!writer.compress(width, height, rgb.data(), quality))
        throw error("cannot encode a JPEG of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels: " + writer.failure());
    return writer.bytes();
}

}  // namespace gs
