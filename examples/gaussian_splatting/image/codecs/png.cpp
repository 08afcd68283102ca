// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <new>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "codec.hpp"

namespace gs {
namespace {

// libpng reports errors by longjmp. So each function that calls it has no objects with destructors in
// its frame; its callers own all resources.

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

    /// Reads the EXIF data that precedes the pixels; leaves it empty if there is none.
    bool read_exif(std::FILE* file, std::size_t file_bytes, std::span<const std::uint8_t>& exif) {
        if (setjmp(png_jmpbuf(png_))) return false;
        // A chunk cannot be larger than the file. By default, libpng only warns of one that claims to
        // be, and allocates memory for it.
        png_set_chunk_malloc_max(png_, file_bytes);
        png_set_benign_errors(png_, 0);
        begin(file, PNG_HANDLE_CHUNK_AS_DEFAULT);
        png_bytep bytes = nullptr;
        png_uint_32 count = 0;
        if (png_get_eXIf_1(png_, info_, &count, &bytes)) exif = {bytes, count};
        return true;
    }

    std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    image_size size() const { return {png_get_image_width(png_, info_), png_get_image_height(png_, info_)}; }

    bool read_rows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }

    std::string failure() const { return failure_.message.data(); }

  private:
    void begin(std::FILE* file, int keep_exif = PNG_HANDLE_CHUNK_NEVER) {
        png_set_user_limits(png_, largest_side, largest_side);
        // Keeps only the chunks for pixels. Texts and profiles may be compressed and expand to
        // megabytes each.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_set_keep_unknown_chunks(png_, keep_exif, reinterpret_cast<png_const_bytep>("eXIf"), 1);
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

constexpr std::size_t signature_bytes = 8;

bool is_png(std::span<const std::uint8_t> start) {
    return start.size() >= signature_bytes && png_sig_cmp(start.data(), 0, signature_bytes) == 0;
}

std::uint64_t big_endian(std::span<const std::uint8_t, 4> bytes) {
    std::uint64_t value = 0;
    for (const std::uint8_t byte : bytes) value = value << 8 | byte;
    return value;
}

// The size has a fixed position.
image_size read_png_size(const image_file& file) {
    std::array<std::uint8_t, 24> start{};
    if (std::fread(start.data(), 1, start.size(), file.rewound()) < start.size())
        file.refuse("it is truncated");
    const std::span<const std::uint8_t, 24> all(start);
    return {big_endian(all.subspan<16, 4>()), big_endian(all.subspan<20, 4>())};
}

[[noreturn]] void refuse_png(const image_file& file, const png_reader& reader) {
    file.refuse("it is damaged or truncated (" + reader.failure() + ")");
}

orientation read_png_orientation(const image_file& file) {
    png_reader reader;
    if (!reader.ready()) throw std::bad_alloc();
    std::span<const std::uint8_t> exif;
    // The pixels may be intact although other chunks are not, so only reading them reports damage.
    if (!reader.read_exif(file.rewound(), file.size_in_bytes(), exif)) return {};
    return orientation_in_exif(exif);
}

void read_png(const image_file& file, image& pixels) {
    png_reader reader;
    if (!reader.ready()) throw std::bad_alloc();
    if (!reader.read_header(file.rewound())) refuse_png(file, reader);
    const image_size size = size_of(pixels);
    file.check_decoded_size(reader.size(), size);
    if (reader.row_bytes() != 4 * size.width) file.refuse("its kind of PNG is not supported");
    auto rows = row_pointers(pixels.rgba.data(), reader.row_bytes(), size.height);
    if (!reader.read_rows(rows.data())) refuse_png(file, reader);
    premultiply(pixels);
}

constexpr std::string_view png_endings[] = {".png"};

}  // namespace

extern constinit const image_codec png_codec{"PNG",         png_endings,          is_png,
                                             read_png_size, read_png_orientation, read_png};

std::vector<std::uint16_t> read_gray_png(const std::filesystem::path& path, int& width, int& height) {
    const image_file file(path);
    if (&codec_of(file) != &png_codec) file.refuse("it is no PNG");
    const image_size size = read_png_size(file);
    file.check_size(size);
    file.check_density(size);
    png_reader reader;
    if (!reader.ready()) throw std::bad_alloc();
    if (!reader.read_deep_header(file.rewound())) refuse_png(file, reader);
    file.check_decoded_size(reader.size(), size);
    if (reader.row_bytes() != 2 * size.width) file.refuse("it has more than one channel");
    std::vector<std::uint16_t> values(size.width * size.height);
    auto rows = row_pointers(reinterpret_cast<std::uint8_t*>(values.data()), reader.row_bytes(), size.height);
    if (!reader.read_rows(rows.data())) refuse_png(file, reader);
    width = static_cast<int>(size.width);
    height = static_cast<int>(size.height);
    return values;
}

void write_png(const std::filesystem::path& file, int width, int height, const std::vector<float>& planes) {
    const auto columns = static_cast<std::size_t>(std::max(width, 0));
    const auto lines = static_cast<std::size_t>(std::max(height, 0));
    const std::size_t plane = columns * lines;
    if (plane == 0 || planes.size() != 3 * plane)
        throw std::invalid_argument("write_png: three planes of width * height pixels are needed");
    std::vector<std::uint8_t> rgb = interleaved(planes);
    auto rows = row_pointers(rgb.data(), 3 * columns, lines);
    atomic_file_write(file, [&](std::ostream& out) {
        png_writer writer;
        if (!writer.ready()) throw std::bad_alloc();
        if (!writer.write_rgb(out, width, height, rows.data()))
            throw error("cannot write " + file.string() + ": " + writer.failure());
    });
}

}  // namespace gs
