// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <stdlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "../../../examples/gaussian_splatting/core/error.hpp"
#include "../../../examples/gaussian_splatting/writers/ply/ply.hpp"
#include "../../support/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;

using gs_test::temporary_folder;

void write_text(const fs::path& file, const std::string& bytes) {
    std::ofstream out(file, std::ios::binary);
    out << bytes;
    REQUIRE(out.good());
}

std::string read_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <typename T>
std::string bytes_of(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

/// All values differ and some are awkward, so that rounding or swapping becomes visible.
gs::gaussians awkward_model(int degree, std::size_t count) {
    gs::gaussians model;
    model.sh_degree = degree;
    std::uint32_t state = 1;
    const auto fill = [&](std::vector<float>& values, int width) {
        values.resize(count * static_cast<std::size_t>(width));
        for (float& v : values) {
            state = state * 1664525U + 1013904223U;
            v = (static_cast<float>(state >> 8) - 8e6F) * 1e-6F;
        }
    };
    fill(model.mean, 3);
    fill(model.log_scale, 3);
    fill(model.quaternion, 4);
    fill(model.opacity, 1);
    fill(model.sh_constant, 3);
    fill(model.sh_rest, model.rest_width());
    if (count > 2) {
        model.mean[0] = -0.0F;
        model.mean[1] = std::numeric_limits<float>::denorm_min();
        model.mean[2] = std::numeric_limits<float>::max();
    }
    return model;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

void check_same(const gs::gaussians& a, const gs::gaussians& b) {
    CHECK(a.sh_degree == b.sh_degree);
    CHECK(same_bits(a.mean, b.mean));
    CHECK(same_bits(a.log_scale, b.log_scale));
    CHECK(same_bits(a.quaternion, b.quaternion));
    CHECK(same_bits(a.opacity, b.opacity));
    CHECK(same_bits(a.sh_constant, b.sh_constant));
    CHECK(same_bits(a.sh_rest, b.sh_rest));
}

/// The message of the error, which must name the file and be one sentence on one line.
std::string message_of_reading(const fs::path& file) {
    try {
        gs::read_ply(file);
    } catch (const gs::error& e) {
        const std::string message = e.what();
        CHECK(message.find(file.string()) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
        return message;
    }
    return "no error";
}

void check_refused(const std::string& bytes, std::initializer_list<const char*> key_words) {
    const temporary_folder folder;
    const fs::path file = folder / "broken.ply";
    write_text(file, bytes);
    const std::string message = message_of_reading(file);
    CAPTURE(message);
    for (const char* word : key_words) {
        CAPTURE(word);
        CHECK(message.find(word) != std::string::npos);
    }
}

using properties = std::vector<std::pair<std::string, std::string>>;  ///< type and name

properties needed_properties() {
    properties result;
    for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                             "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"}) {
        result.emplace_back("float", name);
    }
    return result;
}

std::string header(const std::string& count, const properties& list,
                   const std::string& format = "binary_little_endian") {
    std::string text = "ply\nformat " + format + " 1.0\nelement vertex " + count + "\n";
    for (const auto& [type, name] : list) text += "property " + type + " " + name + "\n";
    return text + "end_header\n";
}

std::string floats(std::size_t count, float value = 1.5F) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) bytes += bytes_of(value);
    return bytes;
}

std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("ply: a round trip keeps every bit at each SH degree") {
    const temporary_folder folder;
    for (int degree = 0; degree <= 3; ++degree) {
        for (const std::size_t count : {0UL, 1UL, 3UL, 3000UL}) {
            CAPTURE(degree);
            CAPTURE(count);
            const gs::gaussians model = awkward_model(degree, count);
            gs::write_ply(folder / "model.ply", model);
            check_same(gs::read_ply(folder / "model.ply"), model);
        }
    }
}

TEST_CASE("ply: coefficients above the largest SH degree are dropped, and the others kept") {
    const temporary_folder folder;
    const gs::gaussians model = awkward_model(3, 4);
    gs::write_ply(folder / "model.ply", model, {.max_sh_degree = 1});
    gs::gaussians expected = model;
    expected.sh_degree = 1;
    expected.sh_rest.clear();
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 9; ++k) expected.sh_rest.push_back(model.sh_rest[45 * i + k]);
    check_same(gs::read_ply(folder / "model.ply"), expected);
}

TEST_CASE("ply: the bytes are those of the reference implementation") {
    const temporary_folder folder;
    const gs::gaussians model = awkward_model(1, 1);
    gs::write_ply(folder / "model.ply", model);

    std::string expected =
        "ply\n"
        "format binary_little_endian 1.0\n"
        "element vertex 1\n"
        "property float x\n"
        "property float y\n"
        "property float z\n"
        "property float nx\n"
        "property float ny\n"
        "property float nz\n"
        "property float f_dc_0\n"
        "property float f_dc_1\n"
        "property float f_dc_2\n"
        "property float f_rest_0\n"
        "property float f_rest_1\n"
        "property float f_rest_2\n"
        "property float f_rest_3\n"
        "property float f_rest_4\n"
        "property float f_rest_5\n"
        "property float f_rest_6\n"
        "property float f_rest_7\n"
        "property float f_rest_8\n"
        "property float opacity\n"
        "property float scale_0\n"
        "property float scale_1\n"
        "property float scale_2\n"
        "property float rot_0\n"
        "property float rot_1\n"
        "property float rot_2\n"
        "property float rot_3\n"
        "end_header\n";
    for (const float v : model.mean) expected += bytes_of(v);
    expected += floats(3, 0);
    for (const float v : model.sh_constant) expected += bytes_of(v);
    // All of red, then green, then blue; the model has RGB of one coefficient after the other.
    for (const std::size_t i : {0U, 3U, 6U, 1U, 4U, 7U, 2U, 5U, 8U}) expected += bytes_of(model.sh_rest[i]);
    expected += bytes_of(model.opacity[0]);
    for (const float v : model.log_scale) expected += bytes_of(v);
    for (const float v : model.quaternion) expected += bytes_of(v);
    CHECK((read_text(folder / "model.ply") == expected));
}

TEST_CASE("ply: that Gaussians are antialiased is a comment, as Brush writes it") {
    const temporary_folder folder;
    gs::gaussians model = awkward_model(0, 2);
    for (const bool antialiased : {false, true}) {
        model.antialiased = antialiased;
        gs::write_ply(folder / "model.ply", model);
        CHECK(gs::read_ply(folder / "model.ply").antialiased == antialiased);
        CHECK((read_text(folder / "model.ply").find("\ncomment SplatRenderMode: mip\nelement vertex") !=
               std::string::npos) == antialiased);
    }
    const std::string text = read_text(folder / "model.ply");
    for (const char* other : {"comment SplatRenderMode: default", "comment mip SplatRenderMode:"}) {
        write_text(folder / "other.ply", with_replaced(text, "comment SplatRenderMode: mip", other));
        CHECK_FALSE(gs::read_ply(folder / "other.ply").antialiased);
    }
}

TEST_CASE("ply: a sky is a comment") {
    const temporary_folder folder;
    const auto file = folder / "model.ply";
    gs::gaussians model = awkward_model(1, 2);
    gs::write_ply(file, model);
    CHECK(gs::read_ply(file).sky.empty());
    CHECK(read_text(file).find("Sky") == std::string::npos);
    for (std::size_t i = 0; i < gs::sky_width; ++i)
        model.sky.push_back(std::ldexp(1.0F / static_cast<float>(i + 3), static_cast<int>(i) - 40));
    model.sky[5] = -0.0F;
    model.antialiased = true;
    gs::write_ply(file, model);
    const gs::gaussians read = gs::read_ply(file);
    CHECK(read.sky == model.sky);
    CHECK(read.antialiased);
    CHECK(read.mean == model.mean);

    const std::string text = read_text(file);
    const std::string first = text.substr(text.find("SkyHarmonics: "), 20);
    const auto with = [&](const std::string& begin) {
        return with_replaced(text, first, "SkyHarmonics: " + begin + " " + first.substr(14));
    };
    check_refused(with("1 2"), {"sky", "more than 48"});
    check_refused(with("1e99"), {"sky", "'1e99'"});
    check_refused(with("blue"), {"sky", "'blue'"});
    check_refused(with("1\ncomment"), {"sky", "1 numbers instead of 48"});
    model.sky[1] = std::numeric_limits<float>::infinity();
    CHECK_THROWS_WITH_AS(gs::write_ply(file, model), doctest::Contains("its sky is not finite"), gs::error);
    CHECK(read_text(file) == text);
}

TEST_CASE("ply: shuffled and further properties of any type, comments and Windows line ends are read") {
    const temporary_folder folder;
    const properties list = {
        {"uchar", "red"},     {"float", "rot_3"},   {"float", "rot_0"},   {"double", "z"},
        {"float", "y"},       {"int16", "x"},       {"int", "label"},     {"float32", "f_dc_2"},
        {"float", "f_dc_0"},  {"float", "f_dc_1"},  {"double", "time"},   {"uint8", "opacity"},
        {"float", "scale_1"}, {"float", "scale_0"}, {"float", "scale_2"}, {"float64", "weight"},
        {"float", "rot_1"},   {"char", "rot_2"},    {"ushort", "a"},      {"uint32", "b"}};
    std::string row = bytes_of<std::uint8_t>(200) + bytes_of(14.0F) + bytes_of(11.0F) + bytes_of(3.25) +
                      bytes_of(2.0F) + bytes_of<std::int16_t>(-1) + bytes_of<std::int32_t>(-7);
    row += bytes_of(6.0F) + bytes_of(4.0F) + bytes_of(5.0F) + bytes_of(std::nan("")) +
           bytes_of<std::uint8_t>(255);
    row += bytes_of(8.0F) + bytes_of(7.5F) + bytes_of(9.0F) + bytes_of(1e300) + bytes_of(12.0F) +
           bytes_of<std::int8_t>(-13) + bytes_of<std::uint16_t>(9) + bytes_of<std::uint32_t>(9);

    std::string text = header("2", list);
    text = with_replaced(text, "element vertex", "comment made by hand\nobj_info none\nelement vertex");
    text =
        with_replaced(text, "end_header", "element face 0\nproperty list uchar int vertex_index\nend_header");
    SUBCASE("Unix line ends") {}
    SUBCASE("Windows line ends") {
        for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) {
            text.insert(at, "\r");
        }
    }
    write_text(folder / "other.ply", text + row + row);

    const gs::gaussians model = gs::read_ply(folder / "other.ply");
    CHECK(model.count() == 2);
    CHECK(model.sh_degree == 0);
    CHECK(model.mean == std::vector<float>{-1, 2, 3.25F, -1, 2, 3.25F});
    CHECK(model.sh_constant == std::vector<float>{4, 5, 6, 4, 5, 6});
    CHECK(model.opacity == std::vector<float>{255, 255});
    CHECK(model.log_scale == std::vector<float>{7.5F, 8, 9, 7.5F, 8, 9});
    CHECK(model.quaternion == std::vector<float>{11, 12, -13, 14, 11, 12, -13, 14});
}

TEST_CASE("ply: each needed property is missed by its name") {
    for (const auto& needed : needed_properties()) {
        const std::string& missing = needed.second;
        properties list = needed_properties();
        std::erase_if(list, [&](const auto& p) { return p.second == missing; });
        const std::string quoted = "'" + missing + "'";
        check_refused(header("1", list) + floats(13), {"no property", quoted.c_str()});
    }
}

TEST_CASE("ply: f_rest properties must fit a degree and be numbered without gaps") {
    properties list = needed_properties();
    for (int i = 0; i < 8; ++i) list.emplace_back("float", "f_rest_" + std::to_string(i));
    check_refused(header("1", list) + floats(22), {"8 properties f_rest_", "0, 9, 24 or 45"});
    list.emplace_back("float", "f_rest_9");
    check_refused(header("1", list) + floats(23), {"no property", "'f_rest_8'"});
}

TEST_CASE("ply: other formats are refused") {
    check_refused(header("1", needed_properties(), "ascii") + "1 1 1 1 1 1 1 1 1 1 1 1 1 1\n", {"ascii"});
    check_refused(header("1", needed_properties(), "binary_big_endian") + floats(14), {"binary_big_endian"});
    check_refused("", {"not a PLY file"});
    check_refused("pl", {"not a PLY file"});
    check_refused("\x89PNG\r\n", {"not a PLY file"});
    check_refused("plywood\n", {"not a PLY file"});
}

TEST_CASE("ply: a format must be said") {
    const std::string text = header("1", needed_properties());
    check_refused(with_replaced(text, "format binary_little_endian 1.0\n", "") + floats(14), {"format"});
}

TEST_CASE("ply: a header that is no header is refused") {
    const std::string text = header("1", needed_properties());
    check_refused(with_replaced(text, "end_header\n", ""), {"no end_header"});
    check_refused(with_replaced(text, "end_header\n", "") + floats(14), {"no end_header"});
    check_refused("ply\n", {"no end_header"});
    check_refused("ply\nformat binary_little_endian 1.0\nend_header\n", {"'vertex'"});
    check_refused("ply\nformat binary_little_endian 1.0\nelement vertex 3\nend_header\n", {"'vertex'"});
    check_refused(with_replaced(text, "property float y", "propeller float y"), {"unknown", "'propeller"});
    check_refused(with_replaced(text, "element vertex 1\n", ""), {"'property"});
    check_refused(with_replaced(text, "float y", "half y"), {"'y'", "'half'"});
    check_refused(with_replaced(text, "float y", "list uchar float y"), {"'y'", "'list'"});
    check_refused(with_replaced(text, "float y", "float x"), {"'x' twice"});
    check_refused(with_replaced(text, "end_header", "element vertex 1\nend_header"), {"'vertex'"});
    check_refused(with_replaced(text, "end_header", "element face 1\nend_header"), {"'face'"});
}

TEST_CASE("ply: a header that goes on and on is refused") {
    const std::string text = header("1", needed_properties());
    const std::string comment = "comment " + std::string(60000, 'a') + "\n";
    const temporary_folder folder;
    write_text(folder / "long.ply", with_replaced(text, "element", comment + "element") + floats(14));
    CHECK(gs::read_ply(folder / "long.ply").count() == 1);
    check_refused(with_replaced(text, "element", comment + comment + "element") + floats(14),
                  {"no end_header", "65536"});
    check_refused(with_replaced(text, "float y", "float " + std::string(5000, 'y') + " y"),
                  {"'y'", "'float'"});
    check_refused(with_replaced(text, "float y", std::string(5000, 'y') + " y"), {"'y'", "yyy ...'"});
}

TEST_CASE("ply: a count that is none is refused") {
    for (const char* count : {"-1", "1.5", "many", "1e3", "99999999999999999999999"}) {
        const std::string quoted = "'" + std::string(count) + "'";
        check_refused(header(count, needed_properties()) + floats(14), {"'vertex'", quoted.c_str()});
    }
}

TEST_CASE("ply: a count that the size contradicts is refused before it is believed") {
    const properties list = needed_properties();
    check_refused(header("2", list) + floats(14), {"2 vertices", "112 bytes", "56 bytes follow"});
    check_refused(header("1", list) + floats(28), {"1 vertices", "56 bytes", "112 bytes follow"});
    check_refused(header("1", list) + floats(14) + "\n", {"56 bytes", "57 bytes follow"});
    check_refused(header("1", list) + floats(13) + "abc", {"56 bytes", "55 bytes follow"});
    check_refused(header("0", list) + floats(14), {"0 vertices", "0 bytes", "56 bytes follow"});
    check_refused(header("1", list), {"56 bytes", "0 bytes follow"});
    check_refused(header("100000000000000000", list) + floats(14),
                  {"100000000000000000 vertices", "56 bytes follow"});
    // 2^61 + 1 vertices of 56 bytes are 56 bytes modulo 2^64.
    check_refused(header("2305843009213693953", list) + floats(14),
                  {"2305843009213693953", "more than 2^64"});
    check_refused(header("18446744073709551615", list) + floats(14), {"18446744073709551615"});
}

TEST_CASE("ply: values that are not finite are refused with their place") {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
        const std::string body = floats(14 + 6) + bytes_of(bad) + floats(7);
        check_refused(header("2", needed_properties()) + body, {"'opacity'", "vertex 1", "finite"});
    }
    properties list = needed_properties();
    list[13].first = "double";
    check_refused(header("1", list) + floats(13) + bytes_of(1e39), {"'rot_3'", "vertex 0", "finite"});
}

TEST_CASE("ply: a file that is not there, and a folder, are refused") {
    const temporary_folder folder;
    CHECK(message_of_reading(folder / "none.ply").find("cannot read") != std::string::npos);
    CHECK(message_of_reading(folder.path()).find("cannot read") != std::string::npos);
}

TEST_CASE("ply: a failing write names the file and leaves the existing one as it was") {
    const temporary_folder folder;
    const fs::path file = folder / "model.ply";
    const gs::gaussians good = awkward_model(0, 3);
    gs::write_ply(file, good);
    // A folder in the place of the temporary file: fails for root, too, whom no permission stops.
    fs::create_directories(folder / "model.ply.part" / "occupied");
    CHECK_THROWS_WITH_AS(gs::write_ply(file, awkward_model(1, 5)), doctest::Contains(file.string().c_str()),
                         gs::error);
    check_same(gs::read_ply(file), good);

    CHECK_THROWS_AS(gs::write_ply(folder / "no such folder" / "model.ply", good), gs::error);
}

TEST_CASE("ply: an unwritable folder leaves the existing file as it was") {
    const temporary_folder folder;
    const fs::path file = folder / "model.ply";
    const gs::gaussians good = awkward_model(0, 3);
    gs::write_ply(file, good);
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    const bool permissions_bind = !std::ofstream(folder / "probe").is_open();
    if (permissions_bind) CHECK_THROWS_AS(gs::write_ply(file, awkward_model(1, 5)), gs::error);
    check_same(gs::read_ply(file), good);
    fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST_CASE("ply: what is not finite never replaces a good file") {
    const temporary_folder folder;
    const fs::path file = folder / "model.ply";
    const gs::gaussians good = awkward_model(1, 3);
    gs::write_ply(file, good);
    gs::gaussians poisoned = good;
    poisoned.log_scale[3 * 2 + 1] = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH_AS(gs::write_ply(file, poisoned),
                         doctest::Contains("'scale_1' of vertex 2 is not finite"), gs::error);
    check_same(gs::read_ply(file), good);
    CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}
