// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "image.hpp"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>

#include "../core/atomic_file_write.hpp"
#include "../core/error.hpp"

// jpeglib.h requires FILE and size_t to be declared.
#include <jpeglib.h>
// jerror.h depends on jpeglib.h.
#include <jerror.h>

namespace gs {
namespace {

constexpr std::uint64_t largest_side = 65536;
constexpr std::uint64_t largest_decoded_bytes = std::uint64_t{1} << 31;

// The densest format that is read is a 1-bit PNG with the best ratio of deflate, 1032 to 1.
constexpr std::uint64_t most_pixels_per_byte = 8 * 1032;

// Each scan of a progressive JPEG visits all pixels, so a small file could take a long time. This
// is the largest number of scans that cjpeg writes.
constexpr int most_scans = 100;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw error("cannot read the image " + file.string() + ": " + why);
}

struct file_closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using open_file = std::unique_ptr<std::FILE, file_closer>;

open_file open_to_read(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) refuse(file, "there is no such file");
    if (!std::filesystem::is_regular_file(file, ignored)) refuse(file, "it is not a file");
    open_file opened(std::fopen(file.c_str(), "rb"));
    if (!opened) refuse(file, std::strerror(errno));
    return opened;
}

void check_size(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width == 0 || height == 0) refuse(file, "it has no pixels (" + size + ")");
    if (width > largest_side || height > largest_side || 4 * width * height > largest_decoded_bytes)
        refuse(file, "its size, " + size + ", is too large");
}

// Refuses a header that promises a huge image although the file is tiny, before memory is
// allocated.
void check_density(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height) {
    std::error_code ignored;
    if (width * height / most_pixels_per_byte > std::filesystem::file_size(file, ignored))
        refuse(file, "it is truncated");
}

image blank_image(int width, int height) {
    image blank;
    blank.width = width;
    blank.height = height;
    blank.rgba.resize(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return blank;
}

void premultiply(image& pixels) {
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
        const unsigned alpha = pixels.rgba[i + 3];
        if (alpha == 255) continue;
        pixels.has_alpha = true;
        for (std::size_t channel = i; channel < i + 3; ++channel)
            pixels.rgba[channel] = static_cast<std::uint8_t>((pixels.rgba[channel] * alpha + 127) / 255);
    }
}

// PNG
//
// libpng and libjpeg report errors by longjmp. So each function that calls them has no objects with
// destructors in its frame; its callers own all resources.

struct png_failure {
    std::array<char, 256> message{};
};

[[noreturn]] void leave_png(png_structp png, png_const_charp message) {
    auto* failure = static_cast<png_failure*>(png_get_error_ptr(png));
    std::snprintf(failure->message.data(), failure->message.size(), "%s", message);
    png_longjmp(png, 1);
}

void ignore_png_warning(png_structp, png_const_charp) {}

class png_reader {
  public:
    png_reader()
        : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure_, leave_png, ignore_png_warning)),
          info_(png_ ? png_create_info_struct(png_) : nullptr) {}
    ~png_reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    png_reader(const png_reader&) = delete;
    png_reader& operator=(const png_reader&) = delete;

    bool ready() const { return png_ && info_; }

    /// Makes `read_rows` yield 8-bit RGBA for every color type.
    bool read_header(std::FILE* file) {
        if (setjmp(png_jmpbuf(png_))) return false;
        begin(file);
        png_set_expand(png_);
        png_set_scale_16(png_);
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 255, PNG_FILLER_AFTER);
        end_header();
        return true;
    }

    /// Makes `read_rows` yield 16 bits per channel, and as many channels as the file has.
    bool read_deep_header(std::FILE* file) {
        if (setjmp(png_jmpbuf(png_))) return false;
        begin(file);
        png_set_expand_16(png_);
        if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
        end_header();
        return true;
    }

    std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }

    bool read_rows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }

    std::string failure() const { return failure_.message.data(); }

  private:
    void begin(std::FILE* file) {
        png_set_user_limits(png_, largest_side, largest_side);
        // Keeps only the chunks for pixels. Texts and profiles may be compressed and expand to
        // megabytes each.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_init_io(png_, file);
        png_read_info(png_, info_);
    }
    void end_header() {
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
    }

    png_failure failure_;
    png_structp png_;
    png_infop info_;
};

std::vector<png_bytep> row_pointers(std::uint8_t* pixels, std::size_t row_bytes, std::size_t height) {
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = pixels + y * row_bytes;
    return rows;
}

image read_png(const std::filesystem::path& file, std::FILE* opened, int width, int height) {
    png_reader reader;
    if (!reader.ready()) throw std::bad_alloc();
    const auto give_up = [&] { refuse(file, "it is damaged or truncated (" + reader.failure() + ")"); };
    if (!reader.read_header(opened)) give_up();
    image pixels = blank_image(width, height);
    const std::size_t row_bytes = std::size_t{4} * static_cast<std::size_t>(width);
    if (reader.row_bytes() != row_bytes) refuse(file, "its kind of PNG is not supported");
    auto rows = row_pointers(pixels.rgba.data(), row_bytes, static_cast<std::size_t>(height));
    if (!reader.read_rows(rows.data())) give_up();
    premultiply(pixels);
    return pixels;
}

class png_writer {
  public:
    png_writer()
        : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure_, leave_png, ignore_png_warning)),
          info_(png_ ? png_create_info_struct(png_) : nullptr) {}
    ~png_writer() { png_destroy_write_struct(&png_, &info_); }
    png_writer(const png_writer&) = delete;
    png_writer& operator=(const png_writer&) = delete;

    bool ready() const { return png_ && info_; }

    bool write_rgb(std::ostream& out, int width, int height, png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_write_fn(png_, &out, put, flush);
        png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                     PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        // On filtered photos, run-length coding compresses as well as zlib's search, and is faster.
        png_set_compression_strategy(png_, Z_RLE);
        png_write_info(png_, info_);
        png_write_image(png_, rows);
        png_write_end(png_, nullptr);
        return true;
    }

    std::string failure() const { return failure_.message.data(); }

  private:
    static void put(png_structp png, png_bytep bytes, png_size_t count) {
        auto* out = static_cast<std::ostream*>(png_get_io_ptr(png));
        out->write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    }
    static void flush(png_structp) {}

    png_failure failure_;
    png_structp png_;
    png_infop info_;
};

// JPEG

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
        jpeg_read_header(&jpeg_, TRUE);
        return true;
    }

    std::uint64_t width() const { return jpeg_.image_width; }
    std::uint64_t height() const { return jpeg_.image_height; }
    bool is_cmyk() const { return jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK; }

    /// Precondition: `pixels` has space for width * height * 4 bytes.
    bool read_rgba(std::uint8_t* pixels) {
        if (setjmp(errors_.escape)) return false;
        jpeg_.out_color_space = JCS_EXT_RGBA;
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

[[noreturn]] void refuse_jpeg(const std::filesystem::path& file, const jpeg_reader& reader) {
    if (reader.found_no_pixels()) refuse(file, "it has no pixels");
    refuse(file, "it is damaged or truncated (" + reader.failure() + ")");
}

void read_jpeg_header(const std::filesystem::path& file, std::FILE* opened, jpeg_reader& reader) {
    if (!reader.read_header(opened)) refuse_jpeg(file, reader);
    check_size(file, reader.width(), reader.height());
}

image read_jpeg(const std::filesystem::path& file, std::FILE* opened) {
    jpeg_reader reader;
    read_jpeg_header(file, opened, reader);
    if (reader.is_cmyk()) refuse(file, "CMYK JPEGs are not supported");
    check_density(file, reader.width(), reader.height());
    image pixels = blank_image(static_cast<int>(reader.width()), static_cast<int>(reader.height()));
    if (!reader.read_rgba(pixels.rgba.data())) refuse_jpeg(file, reader);
    return pixels;
}

// PNG or JPEG

/// The format according to the first bytes of a file. For a PNG also the size, which has a fixed
/// position.
struct first_bytes {
    bool is_png = false;
    std::uint64_t png_width = 0, png_height = 0;
};

std::uint64_t big_endian(std::span<const std::uint8_t, 4> bytes) {
    std::uint64_t value = 0;
    for (const std::uint8_t byte : bytes) value = value << 8 | byte;
    return value;
}

first_bytes look_at(const std::filesystem::path& file, std::FILE* opened) {
    constexpr std::size_t png_signature = 8;
    std::array<std::uint8_t, 24> start{};
    const std::size_t count = std::fread(start.data(), 1, start.size(), opened);
    std::rewind(opened);
    if (count == 0) refuse(file, "it is empty");
    first_bytes found;
    found.is_png = count >= png_signature && png_sig_cmp(start.data(), 0, png_signature) == 0;
    if (found.is_png) {
        if (count < start.size()) refuse(file, "it is truncated");
        const std::span<const std::uint8_t, 24> all(start);
        found.png_width = big_endian(all.subspan<16, 4>());
        found.png_height = big_endian(all.subspan<20, 4>());
        check_size(file, found.png_width, found.png_height);
    } else if (start[0] != 0xFF || start[1] != 0xD8) {
        refuse(file, "it is neither a PNG nor a JPEG");
    }
    return found;
}

}  // namespace

image read_image(const std::filesystem::path& file) {
    const open_file opened = open_to_read(file);
    const first_bytes found = look_at(file, opened.get());
    if (!found.is_png) return read_jpeg(file, opened.get());
    check_density(file, found.png_width, found.png_height);
    return read_png(file, opened.get(), static_cast<int>(found.png_width),
                    static_cast<int>(found.png_height));
}

std::vector<std::uint16_t> read_gray_png(const std::filesystem::path& file, int& width, int& height) {
    const open_file opened = open_to_read(file);
    const first_bytes found = look_at(file, opened.get());
    if (!found.is_png) refuse(file, "it is no PNG");
    check_density(file, found.png_width, found.png_height);
    png_reader reader;
    if (!reader.ready()) throw std::bad_alloc();
    const auto give_up = [&] { refuse(file, "it is damaged or truncated (" + reader.failure() + ")"); };
    if (!reader.read_deep_header(opened.get())) give_up();
    if (reader.row_bytes() != 2 * found.png_width) refuse(file, "it has more than one channel");
    std::vector<std::uint16_t> values(found.png_width * found.png_height);
    auto rows = row_pointers(reinterpret_cast<std::uint8_t*>(values.data()), reader.row_bytes(),
                             static_cast<std::size_t>(found.png_height));
    if (!reader.read_rows(rows.data())) give_up();
    width = static_cast<int>(found.png_width);
    height = static_cast<int>(found.png_height);
    return values;
}

void read_image_size(const std::filesystem::path& file, int& width, int& height) {
    const open_file opened = open_to_read(file);
    const first_bytes found = look_at(file, opened.get());
    if (found.is_png) {
        width = static_cast<int>(found.png_width);
        height = static_cast<int>(found.png_height);
        return;
    }
    jpeg_reader reader;
    read_jpeg_header(file, opened.get(), reader);
    width = static_cast<int>(reader.width());
    height = static_cast<int>(reader.height());
}

void write_png(const std::filesystem::path& file, int width, int height, const std::vector<float>& planes) {
    const auto columns = static_cast<std::size_t>(std::max(width, 0));
    const auto lines = static_cast<std::size_t>(std::max(height, 0));
    const std::size_t plane = columns * lines;
    if (plane == 0 || planes.size() != 3 * plane)
        throw std::invalid_argument("write_png: three planes of width * height pixels are needed");
    std::vector<std::uint8_t> rgb(3 * plane);
    for (std::size_t i = 0; i < plane; ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            rgb[3 * i + channel] = to_byte(planes[channel * plane + i]);
    auto rows = row_pointers(rgb.data(), 3 * columns, lines);
    atomic_file_write(file, [&](std::ostream& out) {
        png_writer writer;
        if (!writer.ready()) throw std::bad_alloc();
        if (!writer.write_rgb(out, width, height, rows.data()))
            throw error("cannot write " + file.string() + ": " + writer.failure());
    });
}

void image::mask_pixel(std::size_t pixel) {
    const auto at = rgba.begin() + static_cast<std::ptrdiff_t>(4 * pixel);
    std::fill(at, at + 3, std::uint8_t{255});
    at[3] = 0;
    has_mask = true;
}

bool image::is_all_masked() const {
    std::size_t i = 0;
    while (i < rgba.size() / 4 && is_masked(i)) ++i;
    return i == rgba.size() / 4;
}

bool image::has_transparent_pixel() const {
    for (std::size_t i = 0; i < rgba.size() / 4; ++i)
        if (rgba[4 * i + 3] != 255 && !is_masked(i)) return true;
    return false;
}

std::uint8_t to_byte(float value) {
    if (!(value > 0)) return 0;  // includes NaN
    return static_cast<std::uint8_t>(std::lround(255.0F * std::min(value, 1.0F)));
}

std::vector<float> over_background(const image& source, const float background[3]) {
    const std::size_t plane = source.rgba.size() / 4;
    std::vector<float> planes(3 * plane);
    for (std::size_t i = 0; i < plane; ++i) {
        if (source.is_masked(i)) {
            for (std::size_t channel = 0; channel < 3; ++channel)
                planes[channel * plane + i] = background[channel];
            continue;
        }
        const float see_through = 1.0F - static_cast<float>(source.rgba[4 * i + 3]) / 255.0F;
        for (std::size_t channel = 0; channel < 3; ++channel)
            planes[channel * plane + i] =
                static_cast<float>(source.rgba[4 * i + channel]) / 255.0F + see_through * background[channel];
    }
    return planes;
}

}  // namespace gs
