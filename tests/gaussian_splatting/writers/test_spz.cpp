// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "../../support/bytes.hpp"
#include "../../support/temporary_folder.hpp"
#include "round_trip.hpp"
#include "writers/spz/spz.hpp"

namespace {

using gs_test::bytes;
using gs_test::error_of;
using gs_test::random_model;
using gs_test::read_back;
using gs_test::read_file;
using gs_test::temporary_folder;
using gs_test::write_file;

std::string written(const gs::gaussians& model, int version) {
    const temporary_folder folder;
    gs::spz_writer.write(folder / "a.spz", model, {.spz_version = version});
    return read_file(folder / "a.spz");
}

std::string unzipped(const std::string& data) {
    std::string result(1 << 20, '\0');
    z_stream stream{};
    REQUIRE(inflateInit2(&stream, 15 + 16) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
    stream.avail_in = static_cast<uInt>(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    REQUIRE(inflate(&stream, Z_FINISH) == Z_STREAM_END);
    result.resize(stream.total_out);
    inflateEnd(&stream);
    return result;
}

std::string zipped(const std::string& data) {
    std::string result(data.size() + 100, '\0');
    z_stream stream{};
    REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
    stream.avail_in = static_cast<uInt>(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    return result;
}

gs::gaussians read_spz_bytes(const std::string& data) {
    const temporary_folder folder;
    write_file(folder / "a.spz", data);
    return gs::spz_writer.read(folder / "a.spz");
}

/// Returns the message without the name of the file.
std::string refused(const std::string& data) {
    const temporary_folder folder;
    const std::string file = (folder / "a.spz").string();
    write_file(file, data);
    const std::string problem = error_of([&] { gs::spz_writer.read(file); });
    REQUIRE(problem.starts_with(file + ": "));
    return problem.substr(file.size() + 2);
}

template <class T>
std::string with(std::string data, std::size_t place, T value) {
    std::memcpy(data.data() + place, &value, sizeof value);
    return data;
}

gs::gaussians one_gaussian() {
    gs::gaussians model = random_model(1, 1);
    model.mean = {1, 2, -0.5f};
    model.log_scale = {-10, -2, 5};
    model.quaternion = {2, 0, 0, 0};
    model.opacity = {0};
    model.sh_constant = {0, 1, -4};
    model.sh_rest = {0.5f, 0, 0, 0, 0, 0.25f, -1, 2, 0};
    return model;
}

/// The content of `one_gaussian`: y and z of the position change their signs, and so do the SH
/// coefficients that are proportional to y and z.
std::string expected_content(std::uint32_t version) {
    bytes file;
    file.put(std::uint32_t{0x5053474e}).put(version).put(std::uint32_t{1});
    for (const int x : {1, 14, 0, 0}) file.put(static_cast<std::uint8_t>(x));
    for (const int x : {0x00, 0x40, 0x00, 0x00, 0x80, 0xff, 0x00, 0x20, 0x00}) file.put(std::uint8_t(x));
    for (const int x : {128, 128, 166, 0, 0, 128, 240}) file.put(std::uint8_t(x));
    file.put(std::uint32_t{3U << 30});  // w is the largest
    for (const int x : {64, 128, 128, 128, 128, 96, 0, 255, 128}) file.put(std::uint8_t(x));
    return file.data();
}

}  // namespace

TEST_CASE("spz: version 3 has the bytes of its layout, with y up") {
    CHECK(unzipped(written(one_gaussian(), 3)) == expected_content(3));
}

TEST_CASE("spz: version 4 has a header and a table of streams") {
    gs::gaussians model = random_model(300, 2);
    model.antialiased = true;
    const std::string file = written(model, 4);
    bytes header;
    header.put(std::uint32_t{0x5053474e}).put(std::uint32_t{4}).put(std::uint32_t{300});
    for (const int x : {2, 15, 1, 6, 32}) header.put(static_cast<std::uint8_t>(x));
    CHECK(file.substr(0, header.data().size()) == header.data());
    std::uint64_t sizes[12];
    std::memcpy(sizes, file.data() + 32, sizeof sizes);
    const std::uint64_t widths[] = {9, 1, 3, 3, 4, 24};
    std::uint64_t total = 32 + sizeof sizes;
    for (int i = 0; i < 6; ++i) {
        CHECK(sizes[2 * i + 1] == 300 * widths[i]);
        total += sizes[2 * i];
    }
    CHECK(file.size() == total);
}

TEST_CASE("spz: both versions hold the same values, in the same order") {
    for (const bool antialiased : {false, true}) {
        gs::gaussians model = random_model(1000, 3);
        model.antialiased = antialiased;
        const gs::gaussians a = read_back(gs::spz_writer, model, {.spz_version = 3});
        const gs::gaussians b = read_back(gs::spz_writer, model, {.spz_version = 4});
        CHECK(a.mean == b.mean);
        CHECK(a.log_scale == b.log_scale);
        CHECK(a.quaternion == b.quaternion);
        CHECK(a.opacity == b.opacity);
        CHECK(a.sh_constant == b.sh_constant);
        CHECK(a.sh_rest == b.sh_rest);
        CHECK(a.antialiased == antialiased);
        CHECK(b.antialiased == antialiased);
        CHECK(std::abs(a.mean[0] - model.mean[0]) < 0.001f);
    }
}

TEST_CASE("spz: version 2 stores x y z of a rotation as bytes") {
    std::string content = expected_content(3);
    content = with(content, 4, std::uint32_t{2});
    const std::size_t rotation = content.size() - 13;
    content.replace(rotation, 4, "\xff\x80\x80", 3);  // x = 1
    const gs::gaussians model = read_spz_bytes(zipped(content));
    CHECK(model.quaternion[1] == doctest::Approx(1));
    CHECK(model.quaternion[0] == doctest::Approx(0));
    CHECK(model.mean == std::vector<float>{1, 2, -0.5f});
}

TEST_CASE("spz: SH coefficients of degree 4 are dropped") {
    std::string content = expected_content(3);
    content = with(content, 12, std::uint8_t{4});
    content += std::string(3 * 24 - 9, '\x90');
    const gs::gaussians model = read_spz_bytes(zipped(content));
    CHECK(model.sh_degree == 3);
    CHECK(model.sh_rest[0] == 0.5f);
    CHECK(model.sh_rest[44] == doctest::Approx(0.125));
}

TEST_CASE("spz: positions have the precision that the size of the model calls for") {
    for (const float size : {0.01f, 0.1f, 1000.0f, 1e5f, 8e6f}) {
        CAPTURE(size);
        gs::gaussians model = random_model(50, 0);
        for (float& x : model.mean) x *= size / 2;
        const gs::gaussians found = read_back(gs::spz_writer, model);
        for (std::size_t i = 0; i < model.mean.size(); ++i)
            CHECK(std::abs(found.mean[i] - model.mean[i]) <= size / 65536);
    }
    gs::gaussians model = random_model(1, 0);
    model.mean[1] = 1e7f;
    CHECK(gs_test::says(error_of([&] { written(model, 4); }), {"position", "1000000", "2^23", "--crop"}));
}

TEST_CASE("spz: malformed files of version 4 are refused with the field") {
    const std::string file = written(random_model(300, 1), 4);
    CHECK(refused("NG") == "it is too short for an SPZ file");
    CHECK(refused(with(file, 0, 'X')) == "it is not an SPZ file, which begins with NGSP");
    CHECK(refused(with(file, 4, std::uint32_t{5})) == "its version is 5, but versions 2 to 4 can be read");
    CHECK(refused(with(file, 12, std::uint8_t{5})) == "its SH degree is 5, but 4 is the highest");
    CHECK(refused(with(file, 13, std::uint8_t{31})) ==
          "its positions have 31 fractional bits, but 30 is the most");
    CHECK(refused(with(file, 15, std::uint8_t{5})) == "it has 5 streams instead of 6");
    CHECK(refused(with(file, 16, std::uint32_t{0xffffffff})) == "its table of streams lies beyond its end");
    CHECK(refused(with(file, 8, std::uint32_t{301})) == "stream 0 has 2700 bytes instead of 2709");
    CHECK(gs_test::says(refused(with(file, 8, std::uint32_t{0xffffffff})),
                        {"its 4294967295 Gaussians are more than its", "bytes can hold"}));
    CHECK(refused(with(file, 32, std::uint64_t{1} << 60)) == "stream 0 lies beyond its end");
    CHECK(refused(with(file, 128 + 4, std::uint64_t{0x123456789abcdef})) ==
          "stream 0 cannot be decompressed");
}

TEST_CASE("spz: malformed files of version 3 are refused with the field") {
    const std::string content = unzipped(written(random_model(300, 1), 3));
    CHECK(refused(zipped("abcdefghijklmnop")) == "it is not an SPZ file, which begins with NGSP");
    CHECK(refused(zipped(with(content, 4, std::uint32_t{1}))) ==
          "its version is 1, but versions 2 to 4 can be read");
    CHECK(refused(zipped(content + "x")) == "it has more data than its Gaussians");
    CHECK(refused(zipped(content.substr(0, content.size() - 1))) ==
          "its data end early or cannot be decompressed");
    CHECK(gs_test::says(refused(zipped(with(content, 8, std::uint32_t{0xffffffff}))),
                        {"its 4294967295 Gaussians are more than its", "bytes can hold"}));
    std::string file = zipped(content);
    file[file.size() - 8] = static_cast<char>(file[file.size() - 8] ^ 1);  // the checksum
    CHECK(refused(file) == "its data end early or cannot be decompressed");
    // Extensions follow the Gaussians.
    CHECK(read_spz_bytes(zipped(with(content, 14, std::uint8_t{2}) + "an extension")).count() == 300);
}
