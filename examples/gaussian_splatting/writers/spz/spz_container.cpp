// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "spz_container.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <ostream>
#include <string>
#include <thread>

#include "../../core/error.hpp"
#include "../../core/parallel.hpp"
#include "../../model/gaussians.hpp"

namespace gs {
namespace {

static_assert(std::endian::native == std::endian::little, "headers are copied as they lie in memory");

constexpr std::uint32_t magic = 0x5053474e;  ///< "NGSP"
constexpr std::uint8_t antialiased_flag = 1, extensions_flag = 2;
constexpr std::uint64_t largest_expansion = 1000;  ///< of a file, when it is decompressed
constexpr int zstd_level = 5;

/// The beginning of all versions. It is compressed up to version 3.
struct common_header {
    std::uint32_t magic_number = magic;
    std::uint32_t version = 0;
    std::uint32_t count = 0;
    std::uint8_t sh_degree = 0;
    std::uint8_t fractional_bits = 0;
    std::uint8_t flags = 0;
    std::uint8_t streams = 0;  ///< version 4 only
};
static_assert(sizeof(common_header) == 16);

/// Follows in version 4.
struct zstd_header {
    std::uint32_t table_offset = 0;  ///< bytes from the beginning of the file
    std::uint32_t reserved[3]{};
};
static_assert(sizeof(zstd_header) == 16);

struct stream_sizes {
    std::uint64_t compressed = 0, decompressed = 0;
};

template <class T>
void write_raw(std::ostream& out, const T* values, std::size_t count) {
    out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

common_header header_of(const spz_content& content) {
    common_header h;
    h.version = static_cast<std::uint32_t>(content.version);
    h.count = static_cast<std::uint32_t>(content.count);
    h.sh_degree = static_cast<std::uint8_t>(content.sh_degree);
    h.fractional_bits = static_cast<std::uint8_t>(content.fractional_bits);
    h.flags = content.antialiased ? antialiased_flag : 0;
    return h;
}

/// Compressed bytes. `bytes` may have room for more than `size`.
struct compressed_stream {
    std::unique_ptr<std::uint8_t[]> bytes;
    std::size_t size = 0;
};

compressed_stream compressed_by_zstd(const std::vector<std::uint8_t>& bytes) {
    const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
    if (!context) throw std::bad_alloc();
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, zstd_level);
    // With one worker or more, the result does not depend on their number.
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_nbWorkers,
                           static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U)));
    const std::size_t most = ZSTD_compressBound(bytes.size());
    compressed_stream result{std::make_unique_for_overwrite<std::uint8_t[]>(most)};
    result.size = ZSTD_compress2(context.get(), result.bytes.get(), most, bytes.data(), bytes.size());
    if (ZSTD_isError(result.size)) throw std::bad_alloc();  // of working memory
    return result;
}

/// A stream of zlib that writes a gzip file. The destructor releases its memory.
class gzip_output {
  public:
    explicit gzip_output(std::ostream& out) : out_(out) {
        constexpr int gzip_format = 15 + 16, default_memory = 8;
        if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_format, default_memory,
                         Z_DEFAULT_STRATEGY) != Z_OK)
            throw std::bad_alloc();
    }
    gzip_output(const gzip_output&) = delete;
    gzip_output& operator=(const gzip_output&) = delete;
    ~gzip_output() { deflateEnd(&stream_); }

    void write(const void* bytes, std::size_t size) {
        constexpr std::size_t at_once = std::size_t{1} << 30;  // zlib counts in 32 bits
        for (std::size_t first = 0; first < size; first += at_once)
            deflate_all(static_cast<const Bytef*>(bytes) + first, std::min(at_once, size - first),
                        Z_NO_FLUSH);
    }
    void finish() { deflate_all(nullptr, 0, Z_FINISH); }

  private:
    void deflate_all(const Bytef* bytes, std::size_t size, int flush) {
        stream_.next_in = const_cast<Bytef*>(bytes);
        stream_.avail_in = static_cast<uInt>(size);
        do {
            stream_.next_out = buffer_.data();
            stream_.avail_out = static_cast<uInt>(buffer_.size());
            deflate(&stream_, flush);
            write_raw(out_, buffer_.data(), buffer_.size() - stream_.avail_out);
        } while (stream_.avail_out == 0);
    }

    std::ostream& out_;
    z_stream stream_{};
    std::array<Bytef, 1 << 14> buffer_{};
};

void write_gzip(std::ostream& out, const spz_content& content) {
    gzip_output gzip(out);
    const common_header header = header_of(content);
    gzip.write(&header, sizeof header);
    for (const auto& stream : content.streams) gzip.write(stream.data(), stream.size());
    gzip.finish();
}

void write_zstd(std::ostream& out, const spz_content& content) {
    std::array<compressed_stream, spz_attributes> compressed;
    std::array<stream_sizes, spz_attributes> sizes;
    for_each_in_parallel(spz_attributes, [&](std::size_t i) {
        compressed[i] = compressed_by_zstd(content.streams[i]);
        sizes[i] = {compressed[i].size, content.streams[i].size()};
    });
    common_header header = header_of(content);
    header.streams = spz_attributes;
    const zstd_header second{.table_offset = sizeof header + sizeof(zstd_header)};
    write_raw(out, &header, 1);
    write_raw(out, &second, 1);
    write_raw(out, sizes.data(), sizes.size());
    for (const compressed_stream& stream : compressed) write_raw(out, stream.bytes.get(), stream.size);
}

class container_input {
  public:
    explicit container_input(opened_file& file) : file_(file) {}

    spz_content read() {
        std::array<std::uint8_t, 2> first{};
        if (file_.size < first.size()) fail("it is too short for an SPZ file");
        read_raw(first.data(), first.size());
        file_.in.seekg(0);
        const bool gzip = first[0] == 0x1f && first[1] == 0x8b;
        gzip ? read_gzip() : read_zstd();
        return std::move(content_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw error(file_.name + ": " + what); }

    template <class T>
    void read_raw(T* values, std::size_t count) {
        file_.in.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
        if (!file_.in) throw error("cannot read " + file_.name);
    }

    void accept(const common_header& h, bool gzip) {
        if (h.magic_number != magic) fail("it is not an SPZ file, which begins with NGSP");
        if (gzip ? h.version < 2 || h.version > 3 : h.version != 4)
            fail("its version is " + std::to_string(h.version) + ", but versions 2 to 4 can be read");
        if (h.sh_degree > 4)
            fail("its SH degree is " + std::to_string(h.sh_degree) + ", but 4 is the highest");
        if (h.fractional_bits > 30)
            fail("its positions have " + std::to_string(h.fractional_bits) +
                 " fractional bits, but 30 is the most");
        content_.version = static_cast<int>(h.version);
        content_.count = h.count;
        content_.sh_degree = h.sh_degree;
        content_.fractional_bits = h.fractional_bits;
        content_.antialiased = (h.flags & antialiased_flag) != 0;
        std::uint64_t bytes = 0;
        for (std::size_t i = 0; i < spz_attributes; ++i) bytes += stream_size(i);
        if (bytes / largest_expansion > file_.size)
            fail("its " + std::to_string(h.count) + " Gaussians are more than its " +
                 std::to_string(file_.size) + " bytes can hold");
    }

    std::size_t stream_size(std::size_t i) const {
        return content_.count * content_.width(static_cast<spz_attribute>(i));
    }

    void read_zstd() {
        common_header header;
        zstd_header second;
        if (file_.size < sizeof header + sizeof second) fail("it is too short for an SPZ file");
        read_raw(&header, 1);
        read_raw(&second, 1);
        accept(header, false);
        std::array<stream_sizes, spz_attributes> sizes;
        if (header.streams != sizes.size())
            fail("it has " + std::to_string(header.streams) + " streams instead of 6");
        if (second.table_offset > file_.size || file_.size - second.table_offset < sizeof sizes)
            fail("its table of streams lies beyond its end");
        file_.in.seekg(second.table_offset);
        read_raw(sizes.data(), sizes.size());
        std::uint64_t rest = file_.size - second.table_offset - sizeof sizes;
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            if (sizes[i].decompressed != stream_size(i))
                fail("stream " + std::to_string(i) + " has " + std::to_string(sizes[i].decompressed) +
                     " bytes instead of " + std::to_string(stream_size(i)));
            if (sizes[i].compressed > rest) fail("stream " + std::to_string(i) + " lies beyond its end");
            rest -= sizes[i].compressed;
            read_zstd_stream(i, static_cast<std::size_t>(sizes[i].compressed));
        }
    }

    void read_zstd_stream(std::size_t i, std::size_t compressed_size) {
        std::vector<std::uint8_t> compressed(compressed_size);
        read_raw(compressed.data(), compressed.size());
        auto& stream = content_.streams[i];
        stream.resize(stream_size(i));
        const std::size_t size =
            ZSTD_decompress(stream.data(), stream.size(), compressed.data(), compressed.size());
        if (ZSTD_isError(size) || size != stream.size())
            fail("stream " + std::to_string(i) + " cannot be decompressed");
    }

    void read_gzip() {
        constexpr int gzip_format = 15 + 16;
        if (inflateInit2(&inflate_, gzip_format) != Z_OK) throw std::bad_alloc();
        const std::unique_ptr<z_stream, decltype(&inflateEnd)> end_at_return(&inflate_, inflateEnd);
        common_header header;
        decompress(&header, sizeof header);
        accept(header, true);
        for (std::size_t i = 0; i < spz_attributes; ++i) {
            content_.streams[i].resize(stream_size(i));
            decompress(content_.streams[i].data(), stream_size(i));
        }
        if ((header.flags & extensions_flag) == 0) require_end();
    }

    /// Decompresses exactly this number of bytes.
    void decompress(void* bytes, std::size_t size) {
        constexpr std::size_t at_once = std::size_t{1} << 30;  // zlib counts in 32 bits
        inflate_.next_out = static_cast<Bytef*>(bytes);
        while (size > 0) {
            const auto part = static_cast<uInt>(std::min(size, at_once));
            inflate_.avail_out = part;
            if (!inflate_more() && inflate_.avail_out > 0) fail_to_decompress();
            size -= part - inflate_.avail_out;
        }
    }

    /// Checks that the data end here, with the right checksum.
    void require_end() {
        Bytef more = 0;
        inflate_.next_out = &more;
        inflate_.avail_out = 1;
        while (inflate_more()) {
        }
        if (inflate_.avail_out == 0) fail("it has more data than its Gaussians");
        if (!ended_) fail_to_decompress();
    }

    /// Decompresses until the output is full or the buffer is empty. Returns false if no more can
    /// follow.
    bool inflate_more() {
        if (ended_ || inflate_.avail_out == 0) return false;
        if (inflate_.avail_in == 0) {
            file_.in.read(reinterpret_cast<char*>(buffer_.data()),
                          static_cast<std::streamsize>(buffer_.size()));
            inflate_.next_in = buffer_.data();
            inflate_.avail_in = static_cast<uInt>(file_.in.gcount());
        }
        const int result = inflate(&inflate_, Z_NO_FLUSH);  // Z_BUF_ERROR at the end of the file
        ended_ = result == Z_STREAM_END;
        return result == Z_OK;
    }

    [[noreturn]] void fail_to_decompress() const { fail("its data end early or cannot be decompressed"); }

    opened_file& file_;
    spz_content content_;
    z_stream inflate_{};
    bool ended_ = false;  ///< whether the end of the data was found
    std::array<Bytef, 1 << 14> buffer_{};
};

}  // namespace

std::size_t spz_content::width(spz_attribute a) const {
    switch (a) {
        case spz_attribute::position:
            return 9;
        case spz_attribute::alpha:
            return 1;
        case spz_attribute::color:
        case spz_attribute::scale:
            return 3;
        case spz_attribute::rotation:
            return version == 2 ? 3 : 4;
        case spz_attribute::sh:
            break;
    }
    return static_cast<std::size_t>(3 * (sh_coefficients(sh_degree) - 1));
}

void write_spz_container(std::ostream& out, const spz_content& content) {
    content.version == 4 ? write_zstd(out, content) : write_gzip(out, content);
}

spz_content read_spz_container(opened_file& file) { return container_input(file).read(); }

}  // namespace gs
