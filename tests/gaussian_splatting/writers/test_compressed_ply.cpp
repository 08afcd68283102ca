// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "model/spherical_harmonics.hpp"
#include "round_trip.hpp"
#include "writers/compressed_ply/compressed_ply.hpp"

namespace {

using gs_test::error_of;
using gs_test::random_model;
using gs_test::read_back;
using gs_test::read_file;
using gs_test::temporary_folder;
using gs_test::write_file;

const std::string end_header = "end_header\n";

/// Returns a file of the format with some text replaced in its header.
std::string changed(const std::string& whole, const std::string& from, const std::string& to) {
    std::string result = whole;
    const std::size_t at = result.find(from);
    REQUIRE(at != std::string::npos);
    return result.replace(at, from.size(), to);
}

std::string written(const gs::gaussians& model) {
    const temporary_folder folder;
    gs::compressed_ply_writer.write(folder / "a.compressed.ply", model, {});
    return read_file(folder / "a.compressed.ply");
}

}  // namespace

TEST_CASE("compressed_ply: a file has the bytes of PlayCanvas") {
    gs::gaussians model;
    model.sh_degree = 1;
    model.mean = {1, 2, 3, 3, 6, 11};
    model.log_scale = {-1, -2, -3, -30, -2, -1};
    model.quaternion = {2, 0, 0, 0, 0, 0, 0, -1};
    model.opacity = {0, 80};
    for (const float color : {0.0f, 1.0f, 0.5f, 1.0f, 0.0f, 0.5f})
        model.sh_constant.push_back(gs::sh_from_color(color));
    model.sh_rest = {-4, -1, 0, 1, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    const std::string file = written(model);
    const std::size_t at = file.find(end_header) + end_header.size();
    REQUIRE(file.size() == at + 72 + 2 * 16 + 2 * 9);
    float ranges[18];
    std::memcpy(ranges, file.data() + at, sizeof ranges);
    const float expected_ranges[] = {1, 2, 3, 3, 6, 11, -20, -2, -3, -1, -2, -1};
    for (int i = 0; i < 12; ++i) CHECK(ranges[i] == expected_ranges[i]);
    std::uint32_t packed[8];
    std::memcpy(packed, file.data() + at + 72, sizeof packed);
    // The unit rotation has its largest component first, and three others of 0: 511.5, rounded.
    CHECK(packed[0] == 0);
    CHECK(packed[1] == (0U << 30 | 512U << 20 | 512U << 10 | 512U));
    CHECK(packed[2] == (2047U << 21 | 0U << 11 | 0U));
    CHECK(packed[3] == 0x00ff0080);
    CHECK(packed[4] == 0xffffffff);
    CHECK(packed[5] == (3U << 30 | 512U << 20 | 512U << 10 | 512U));
    CHECK(packed[6] == (0U << 21 | 0U << 11 | 2047U));
    CHECK(packed[7] == 0xff0000ff);
    // Three coefficients of red, then of green, then of blue.
    const unsigned char sh[] = {0, 160, 128, 96, 255, 128, 128, 128, 128};
    CHECK(file.substr(at + 72 + 32, 9) == std::string(reinterpret_cast<const char*>(sh), 9));
}

TEST_CASE("compressed_ply: antialiasing and a learned background are kept") {
    gs::gaussians model = random_model(5, 0);
    model.antialiased = true;
    for (std::size_t i = 0; i < gs::sky_width; ++i) model.sky.push_back(0.1f * static_cast<float>(i));
    const gs::gaussians found = read_back(gs::compressed_ply_writer, model);
    CHECK(found.antialiased);
    CHECK(found.sky == model.sky);
    model.antialiased = false;
    CHECK_FALSE(read_back(gs::compressed_ply_writer, model).antialiased);
}

TEST_CASE("compressed_ply: malformed files are refused with the field") {
    const temporary_folder folder;
    const std::string whole = written(random_model(300, 1));
    const auto refused = [&](const std::string& bytes) {
        write_file(folder / "a.compressed.ply", bytes);
        return error_of([&] { gs::compressed_ply_writer.read(folder / "a.compressed.ply"); });
    };
    CHECK(refused(whole).empty());
    const std::string name = (folder / "a.compressed.ply").string();
    CHECK(
        refused(changed(whole, "element vertex 300", "element vertex 301")) ==
        name +
            ": its 2 rows 'chunk' of 72 bytes, 301 vertices of 16 bytes and 300 rows 'sh' of 9 bytes make " +
            "7660 bytes, but 7644 bytes follow the header");
    CHECK(refused(changed(whole, "element vertex 300", "element vertices 300")) ==
          name + ": it has the element 'vertices', but only chunk, vertex and sh can be read");
    CHECK(refused(changed(whole, "float min_y", "float mix_y")) ==
          name + ": property 1 of its element 'chunk' is not min_y");
    CHECK(refused(changed(whole, "uint packed_scale", "int packed_scale")) ==
          name + ": property 2 of its element 'vertex' is not packed_scale");
    CHECK(refused(changed(whole, "f_rest_4", "f_rest_5")) == name + ": it has the property 'f_rest_5' twice");
    CHECK(refused(changed(whole, "property uchar f_rest_8\n", "")) ==
          name + ": its rows 'sh' have 8 bytes, but SH degrees 1 to 3 have 9, 24 or 45");
    CHECK(refused(changed(whole, "property uchar f_rest_0", "property char f_rest_0")) ==
          name + ": property 0 of its element 'sh' is not f_rest_0");
    std::string infinite = whole;
    const std::size_t at = whole.find(end_header) + end_header.size();
    infinite.replace(at + 72, 4, std::string("\x00\x00\x80\x7f", 4));
    CHECK(refused(infinite) == name + ": a range of chunk 1 is not finite");
}

TEST_CASE("compressed_ply: rows without properties are refused before memory is allocated for them") {
    const temporary_folder folder;
    const std::string name = (folder / "a.compressed.ply").string();
    write_file(name,
               "ply\nformat binary_little_endian 1.0\nelement chunk 36028797018963968\n"
               "element vertex 9223372036854775808\nend_header\n");
    CHECK(error_of([&] { gs::compressed_ply_writer.read(name); }) ==
          name + ": property 0 of its element 'chunk' is not min_x");
}
