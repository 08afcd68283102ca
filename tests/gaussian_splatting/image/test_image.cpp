// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <fcntl.h>
#include <png.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <utility>

#include "../../support/temporary_folder.hpp"
#include "image/depth_map.hpp"
#include "image/image.hpp"
#include "make_images.hpp"
#include "pixel_at.hpp"
#include "write_jpeg.hpp"

namespace {

using gs::image;
using gs_test::error_of;
using gs_test::pixel;
using gs_test::pixel_at;
using gs_test::says;
using gs_test::smooth_samples;
using gs_test::temporary_folder;
using gs_test::write_jpeg;

// ---------------------------------------------------------------------------------------- PNGs of any kind

struct png_kind {
    int color_type;
    int depth;
    bool interlaced;
    bool transparent;  ///< has a tRNS chunk
};

int channels_of(int color_type) {
    switch (color_type) {
        case PNG_COLOR_TYPE_GRAY_ALPHA:
            return 2;
        case PNG_COLOR_TYPE_RGB:
            return 3;
        case PNG_COLOR_TYPE_RGB_ALPHA:
            return 4;
        default:
            return 1;
    }
}

/// Random samples of the whole image, in its depth.
std::vector<unsigned> random_samples(const png_kind& kind, int width, int height) {
    std::mt19937 random(7);
    std::vector<unsigned> samples(static_cast<std::size_t>(width * height * channels_of(kind.color_type)));
    for (unsigned& sample : samples) sample = static_cast<unsigned>(random()) & ((1U << kind.depth) - 1U);
    return samples;
}

/// Rows of samples as a PNG has them: packed from the highest bit on, 16 bits big-endian.
std::vector<std::vector<png_byte>> packed(const std::vector<unsigned>& samples, int height, int depth) {
    std::vector<std::vector<png_byte>> rows(static_cast<std::size_t>(height));
    const std::size_t per_row = samples.size() / rows.size();
    for (std::size_t y = 0; y < rows.size(); ++y) {
        unsigned bits = 0;
        for (std::size_t x = 0; x < per_row; ++x)
            for (int bit = depth - 1; bit >= 0; --bit, ++bits) {
                if (bits % 8 == 0) rows[y].push_back(0);
                const unsigned value = (samples[y * per_row + x] >> bit) & 1U;
                rows[y].back() = static_cast<png_byte>(rows[y].back() | (value << (7 - bits % 8)));
            }
    }
    return rows;
}

pixel palette_entry(unsigned index) {
    return {static_cast<std::uint8_t>(37 * index + 11), static_cast<std::uint8_t>(91 * index + 5),
            static_cast<std::uint8_t>(200 - 13 * index),
            static_cast<std::uint8_t>(index < 3 ? 60 * index : 255)};
}

constexpr unsigned transparent_sample = 1;  // the gray level, or each of red, green and blue, of tRNS

void write_any_png(const std::filesystem::path& file, const png_kind& kind, int width, int height,
                   const std::vector<unsigned>& samples) {
    auto rows = packed(samples, height, kind.depth);
    std::vector<png_bytep> pointers;
    for (auto& row : rows) pointers.push_back(row.data());
    std::array<png_color, 256> palette{};
    std::array<png_byte, 256> alphas{};
    for (unsigned i = 0; i < 256; ++i) {
        const pixel entry = palette_entry(i);
        palette[i] = {entry[0], entry[1], entry[2]};
        alphas[i] = entry[3];
    }
    png_color_16 color{};
    color.gray = color.red = color.green = color.blue = transparent_sample;

    std::FILE* out = std::fopen(file.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, out);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), kind.depth,
                 kind.color_type, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const bool has_palette = kind.color_type == PNG_COLOR_TYPE_PALETTE;
    if (has_palette) png_set_PLTE(png, info, palette.data(), 1 << kind.depth);
    if (kind.transparent)
        png_set_tRNS(png, info, has_palette ? alphas.data() : nullptr, has_palette ? 2 : 1, &color);
    png_write_info(png, info);
    png_write_image(png, pointers.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(out);
}

std::uint8_t to_8_bit(unsigned sample, int depth) {
    return static_cast<std::uint8_t>(std::lround(255.0 * sample / ((1U << depth) - 1U)));
}

/// What the n-th pixel must be once read, from the definition of each color type.
pixel expected_pixel(const png_kind& kind, const std::vector<unsigned>& samples, std::size_t n) {
    const auto channels = static_cast<std::size_t>(channels_of(kind.color_type));
    const unsigned* s = samples.data() + n * channels;
    const auto byte = [&](std::size_t channel) { return to_8_bit(s[channel], kind.depth); };
    pixel straight{};
    switch (kind.color_type) {
        case PNG_COLOR_TYPE_PALETTE:
            straight = palette_entry(s[0]);
            if (!kind.transparent || s[0] >= 2) straight[3] = 255;
            break;
        case PNG_COLOR_TYPE_GRAY:
            straight = {byte(0), byte(0), byte(0), 255};
            if (kind.transparent && s[0] == transparent_sample) straight[3] = 0;
            break;
        case PNG_COLOR_TYPE_GRAY_ALPHA:
            straight = {byte(0), byte(0), byte(0), byte(1)};
            break;
        case PNG_COLOR_TYPE_RGB:
            straight = {byte(0), byte(1), byte(2), 255};
            break;
        default:
            straight = {byte(0), byte(1), byte(2), byte(3)};
    }
    for (std::size_t channel = 0; channel < 3; ++channel)
        straight[channel] = static_cast<std::uint8_t>(std::lround(straight[channel] * straight[3] / 255.0));
    return straight;
}

std::vector<png_kind> every_png_kind() {
    const std::pair<int, std::vector<int>> allowed[] = {
        {PNG_COLOR_TYPE_GRAY, {1, 2, 4, 8, 16}}, {PNG_COLOR_TYPE_PALETTE, {1, 2, 4, 8}},
        {PNG_COLOR_TYPE_GRAY_ALPHA, {8, 16}},    {PNG_COLOR_TYPE_RGB, {8, 16}},
        {PNG_COLOR_TYPE_RGB_ALPHA, {8, 16}},
    };
    std::vector<png_kind> kinds;
    for (const auto& [type, depths] : allowed)
        for (const int depth : depths)
            for (const bool interlaced : {false, true})
                for (const bool transparent : {false, true}) {
                    if (transparent && (type & PNG_COLOR_MASK_ALPHA)) continue;
                    kinds.push_back({type, depth, interlaced, transparent});
                }
    return kinds;
}

void write_gray_png(const std::filesystem::path& file, int width, int height) {
    const png_kind gray{PNG_COLOR_TYPE_GRAY, 8, false, false};
    write_any_png(file, gray, width, height, random_samples(gray, width, height));
}

// ------------------------------------------------------------------------------------------------ damage

void put_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

/// The PNG with another size in its header, whose checksum is put right.
std::string with_png_size(std::string png, std::uint32_t width, std::uint32_t height) {
    put_big_endian(png, 16, width);
    put_big_endian(png, 20, height);
    put_big_endian(png, 29, gs_test::crc_of(png.substr(12, 17)));
    return png;
}

/// The baseline JPEG with another size in its frame header.
std::string with_jpeg_size(std::string jpeg, unsigned width, unsigned height) {
    const std::size_t frame = jpeg.find("\xFF\xC0");
    jpeg[frame + 5] = static_cast<char>(height >> 8);
    jpeg[frame + 6] = static_cast<char>(height);
    jpeg[frame + 7] = static_cast<char>(width >> 8);
    jpeg[frame + 8] = static_cast<char>(width);
    return jpeg;
}

std::string error_of_reading(const std::filesystem::path& file) {
    return error_of([&] { gs::read_image(file); });
}

std::string error_of_reading_size(const std::filesystem::path& file) {
    int width = 0, height = 0;
    return error_of([&] { gs::read_image_size(file, width, height); });
}

/// Redirects stderr to a file.
class captured_stderr {
  public:
    explicit captured_stderr(const std::filesystem::path& file) : kept_(dup(STDERR_FILENO)) {
        const int to = open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
        dup2(to, STDERR_FILENO);
        close(to);
    }
    ~captured_stderr() {
        dup2(kept_, STDERR_FILENO);
        close(kept_);
    }
    captured_stderr(const captured_stderr&) = delete;
    captured_stderr& operator=(const captured_stderr&) = delete;

  private:
    int kept_;
};

}  // namespace

TEST_CASE("one channel is read in 16 bit, whatever the file has, and several are refused") {
    const temporary_folder folder;
    const auto file = folder / "depths.png";
    for (const int depth : {1, 2, 4, 8, 16})
        for (const bool interlaced : {false, true}) {
            CAPTURE(depth);
            const png_kind gray{PNG_COLOR_TYPE_GRAY, depth, interlaced, false};
            const auto samples = random_samples(gray, 13, 7);
            write_any_png(file, gray, 13, 7, samples);
            int width = 0, height = 0;
            const std::vector<std::uint16_t> values = gs::read_gray_png(file, width, height);
            CHECK(std::pair{width, height} == std::pair{13, 7});
            REQUIRE(values.size() == samples.size());
            const unsigned spread = 65535 / ((1U << depth) - 1U);
            for (std::size_t i = 0; i < samples.size(); ++i) CHECK(values[i] == spread * samples[i]);
        }
    for (const int color_type : {PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA}) {
        const png_kind kind{color_type, 8, false, false};
        write_any_png(file, kind, 13, 7, random_samples(kind, 13, 7));
        CHECK(says(error_of([&] { gs::read_depth_map(file, 13, 7); }), {"depths.png", "one channel"}));
    }
    write_jpeg(file, 13, 7, {JCS_GRAYSCALE}, smooth_samples(13, 7, 1));
    CHECK(says(error_of([&] { gs::read_depth_map(file, 13, 7); }), {"depths.png", "no PNG"}));
}

TEST_CASE("what write_png writes, read_image reads") {
    const temporary_folder folder;
    const int width = 17, height = 16, plane = width * height;
    std::vector<float> planes;
    for (int i = 0; i < 3 * plane; ++i) planes.push_back(static_cast<float>((i * 7) % 256) / 255.0F);
    gs::write_png(folder / "a.png", width, height, planes);
    const image read = gs::read_image(folder / "a.png");
    REQUIRE(read.width == width);
    REQUIRE(read.height == height);
    CHECK_FALSE(read.has_alpha);
    for (int i = 0; i < plane; ++i) {
        const pixel expected{static_cast<std::uint8_t>(i * 7), static_cast<std::uint8_t>((i + plane) * 7),
                             static_cast<std::uint8_t>((i + 2 * plane) * 7), 255};
        REQUIRE(pixel_at(read, i % width, i / width) == expected);
    }
}

TEST_CASE("write_png clamps, rounds to nearest, and takes NaN for black") {
    const temporary_folder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    gs::write_png(folder / "a.png", 2, 1, {-3.0F, 0.4F / 255, nan, 1.7F, 0.6F / 255, inf});
    const image read = gs::read_image(folder / "a.png");
    CHECK(pixel_at(read, 0, 0) == pixel{0, 0, 1, 255});
    CHECK(pixel_at(read, 1, 0) == pixel{0, 255, 255, 255});
}

TEST_CASE("write_png names the file it cannot write and leaves nothing behind") {
    const temporary_folder folder;
    const std::vector<float> planes(3, 0.5F);
    CHECK(says(error_of([&] { gs::write_png(folder / "none/a.png", 1, 1, planes); }), {"none/a.png"}));
    CHECK_THROWS_AS(gs::write_png(folder / "a.png", 2, 1, planes), std::invalid_argument);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("PNGs of every color type and depth, interlaced or not, transparent or not") {
    const temporary_folder folder;
    const int width = 13, height = 11;  // odd, so that rows end within a byte
    for (const png_kind& kind : every_png_kind()) {
        CAPTURE(kind.color_type);
        CAPTURE(kind.depth);
        CAPTURE(kind.interlaced);
        CAPTURE(kind.transparent);
        auto samples = random_samples(kind, width, height);
        for (std::size_t i = 0; i < 3; ++i) samples[i] = transparent_sample;  // 16-bit samples rarely hit it
        write_any_png(folder / "a.png", kind, width, height, samples);
        const image read = gs::read_image(folder / "a.png");
        REQUIRE(read.width == width);
        REQUIRE(read.height == height);
        bool transparent = false;
        for (int i = 0; i < width * height; ++i) {
            pixel expected = expected_pixel(kind, samples, static_cast<std::size_t>(i));
            if (kind.transparent && kind.color_type == PNG_COLOR_TYPE_RGB && i == 0) expected = {0, 0, 0, 0};
            transparent |= expected[3] != 255;
            REQUIRE(pixel_at(read, i % width, i / width) == expected);
        }
        CHECK(read.has_alpha == transparent);
    }
}

TEST_CASE("JPEGs, gray and RGB, baseline and progressive") {
    const temporary_folder folder;
    const int width = 37, height = 21;
    for (const J_COLOR_SPACE space : {JCS_GRAYSCALE, JCS_RGB})
        for (const bool progressive : {false, true}) {
            const int channels = space == JCS_GRAYSCALE ? 1 : 3;
            const auto samples = smooth_samples(width, height, channels);
            write_jpeg(folder / "a.jpg", width, height, {space, progressive}, samples);
            const image read = gs::read_image(folder / "a.jpg");
            REQUIRE(read.width == width);
            REQUIRE(read.height == height);
            CHECK_FALSE(read.has_alpha);
            for (int i = 0; i < width * height; ++i) {
                const pixel got = pixel_at(read, i % width, i / width);
                REQUIRE(got[3] == 255);
                for (int channel = 0; channel < 3; ++channel) {
                    const int sample = samples[static_cast<std::size_t>(channels * i + channel % channels)];
                    // Quantized by 1 in frequency, and rounded on the way to YCbCr and back.
                    REQUIRE(std::abs(got[static_cast<std::size_t>(channel)] - sample) <= 3);
                }
            }
        }
}

TEST_CASE("the size alone is the size of the decoded image") {
    const temporary_folder folder;
    write_gray_png(folder / "a.png", 19, 7);
    write_jpeg(folder / "a.jpg", 23, 5, {JCS_RGB}, smooth_samples(23, 5, 3));
    int width = 0, height = 0;
    gs::read_image_size(folder / "a.png", width, height);
    CHECK(width == 19);
    CHECK(height == 7);
    gs::read_image_size(folder / "a.jpg", width, height);
    CHECK(width == 23);
    CHECK(height == 5);
}

TEST_CASE("an image that is not there, or not an image") {
    const temporary_folder folder;
    gs_test::write_file(folder / "empty.png", "");
    gs_test::write_file(folder / "text.png", "this is no image at all, but long enough for one");
    std::filesystem::create_directory(folder / "folder.png");
    for (const auto& reading : {error_of_reading, error_of_reading_size}) {
        CHECK(says(reading(folder / "none.png"), {"none.png", "no such file"}));
        CHECK(says(reading(folder / "empty.png"), {"empty.png", "empty"}));
        CHECK(says(reading(folder / "text.png"), {"text.png", "not a PNG"}));
        CHECK(says(reading(folder / "folder.png"), {"folder.png", "not a file"}));
    }
}

TEST_CASE("images without pixels, with too many, or with too few bytes for them") {
    const temporary_folder folder;
    write_gray_png(folder / "a.png", 5, 4);
    write_jpeg(folder / "a.jpg", 5, 4, {JCS_RGB}, smooth_samples(5, 4, 3));
    const std::string png = gs_test::read_file(folder / "a.png"), jpeg = gs_test::read_file(folder / "a.jpg");
    const auto error_of_bytes = [&](const std::string& bytes) {
        gs_test::write_file(folder / "b.img", bytes);
        return error_of_reading(folder / "b.img");
    };
    CHECK(error_of_bytes(with_png_size(png, 5, 4)).empty());
    CHECK(says(error_of_bytes(with_png_size(png, 0, 4)), {"b.img", "no pixels"}));
    CHECK(says(error_of_reading_size(folder / "b.img"), {"b.img", "no pixels"}));
    CHECK(says(error_of_bytes(with_png_size(png, 5, 0)), {"b.img", "no pixels"}));
    CHECK(says(error_of_bytes(with_png_size(png, 65537, 1)), {"b.img", "65537x1", "too large"}));
    CHECK(says(error_of_bytes(with_png_size(png, 0xFFFFFFFF, 0xFFFFFFFF)), {"b.img", "too large"}));
    CHECK(says(error_of_bytes(with_png_size(png, 65536, 65536)), {"b.img", "65536x65536", "too large"}));
    CHECK(says(error_of_bytes(with_png_size(png, 20000, 20000)), {"b.img", "truncated"}));
    CHECK(says(error_of_bytes(with_png_size(png, 5, 5)), {"b.img", "truncated"}));
    CHECK(says(error_of_bytes(with_jpeg_size(jpeg, 5, 0)), {"b.img", "no pixels"}));
    CHECK(says(error_of_reading_size(folder / "b.img"), {"b.img", "no pixels"}));
    CHECK(says(error_of_bytes(with_jpeg_size(jpeg, 65500, 65500)), {"b.img", "65500x65500", "too large"}));
    CHECK(says(error_of_bytes(with_jpeg_size(jpeg, 20000, 20000)), {"b.img", "truncated"}));
    CHECK(says(error_of_bytes(with_jpeg_size(jpeg, 50, 40)), {"b.img", "truncated"}));
}

TEST_CASE("a JPEG of more scans than a photo has is refused, however few bytes they take") {
    const temporary_folder folder;
    write_jpeg(folder / "a.jpg", 64, 64, {JCS_GRAYSCALE, true}, smooth_samples(64, 64, 1));
    const std::string jpeg = gs_test::read_file(folder / "a.jpg");
    // The first scan, of the blocks' means, again and again: up to the next one's Huffman table.
    const std::size_t scan = jpeg.find("\xFF\xDA"), end = jpeg.find("\xFF\xC4", scan);
    const auto with_scans = [&](int more) {
        std::string bytes = jpeg.substr(0, scan);
        for (int i = 0; i < more; ++i) bytes += jpeg.substr(scan, end - scan);
        gs_test::write_file(folder / "b.jpg", bytes + jpeg.substr(scan));
        return error_of_reading(folder / "b.jpg");
    };
    CHECK(with_scans(0).empty());
    CHECK(with_scans(50).empty());
    CHECK(says(with_scans(100), {"b.jpg", "more than 100 scans"}));
}

TEST_CASE("CMYK and YCCK JPEGs, as ink and as Adobe's inverted values") {
    const temporary_folder folder;
    const int width = 16, height = 16;  // whole blocks of one color, so that only rounding changes them
    const std::array<std::uint8_t, 4> ink{30, 100, 200, 60};
    const std::array<int, 3> expected{(255 - 30) * (255 - 60) / 255, (255 - 100) * (255 - 60) / 255,
                                      (255 - 200) * (255 - 60) / 255};
    for (const bool adobe : {false, true})
        for (const bool ycck : {false, true}) {
            if (ycck && !adobe) continue;  // YCCK without Adobe's marker counts as CMYK
            CAPTURE(adobe);
            CAPTURE(ycck);
            std::vector<std::uint8_t> samples;
            for (int i = 0; i < width * height; ++i)
                for (const std::uint8_t one : ink)
                    samples.push_back(adobe ? static_cast<std::uint8_t>(255 - one) : one);
            write_jpeg(folder / "a.jpg", width, height, {JCS_CMYK, false, adobe, ycck}, samples);
            const image read = gs::read_image(folder / "a.jpg");
            CHECK_FALSE(read.has_alpha);
            for (int i = 0; i < width * height; ++i) {
                const pixel got = pixel_at(read, i % width, i / width);
                REQUIRE(got[3] == 255);
                for (std::size_t channel = 0; channel < 3; ++channel)
                    REQUIRE(std::abs(got[channel] - expected[channel]) <= 2);
            }
        }
}

TEST_CASE("whatever is cut off or changed in an image, the outcome is an error or an image, and silence") {
    const temporary_folder folder;
    const png_kind kinds[] = {{PNG_COLOR_TYPE_RGB_ALPHA, 8, true, false},
                              {PNG_COLOR_TYPE_PALETTE, 4, false, true}};
    std::vector<std::string> originals;
    for (const png_kind& kind : kinds) {
        write_any_png(folder / "a.png", kind, 9, 6, random_samples(kind, 9, 6));
        originals.push_back(gs_test::read_file(folder / "a.png"));
    }
    for (const bool progressive : {false, true}) {
        write_jpeg(folder / "a.jpg", 9, 6, {JCS_RGB, progressive}, smooth_samples(9, 6, 3));
        originals.push_back(gs_test::read_file(folder / "a.jpg"));
    }
    std::size_t cut_but_read = 0, nameless = 0, refused = 0;
    {
        const captured_stderr silence(folder / "stderr");
        const auto file = folder / "b.img";
        for (const std::string& original : originals) {
            for (std::size_t length = 0; length < original.size(); ++length) {
                gs_test::write_file(file, original.substr(0, length));
                const std::string problem = error_of_reading(file);
                if (problem.empty()) ++cut_but_read;
                if (!problem.empty() && !says(problem, {"b.img"})) ++nameless;
            }
            for (std::size_t i = 0; i < original.size(); ++i) {
                std::string changed = original;
                changed[i] = static_cast<char>(~changed[i]);
                gs_test::write_file(file, changed);
                const std::string problem = error_of_reading(file);
                refused += !problem.empty();
                if (!problem.empty() && !says(problem, {"b.img"})) ++nameless;
            }
        }
    }
    CHECK(cut_but_read == 0);
    CHECK(nameless == 0);
    CHECK(refused > 0);
    CHECK(gs_test::read_file(folder / "stderr").empty());
}

TEST_CASE("a transparent pixel's hidden color does not bleed into the average") {
    const temporary_folder folder;
    const png_kind kind{PNG_COLOR_TYPE_RGB_ALPHA, 8, false, false};
    write_any_png(folder / "a.png", kind, 2, 1, {255, 0, 0, 255, 0, 255, 0, 0});
    const image read = gs::read_image(folder / "a.png");
    CHECK(pixel_at(read, 1, 0) == pixel{0, 0, 0, 0});
    CHECK(read.has_alpha);
    const image mean = gs::downsample(read, 1, 1);
    CHECK(pixel_at(mean, 0, 0) == pixel{128, 0, 0, 128});
    CHECK(mean.has_alpha);
}
