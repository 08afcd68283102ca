// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "../../support/bytes.hpp"
#include "../../support/temporary_folder.hpp"
#include "model/spherical_harmonics.hpp"
#include "writers/splat/splat.hpp"

namespace {

using gs_test::bytes;
using gs_test::error_of;
using gs_test::read_file;
using gs_test::temporary_folder;
using gs_test::write_file;

/// A record of the file, made value by value.
bytes& put_record(bytes& file, std::vector<float> position_and_scale,
                  std::vector<int> color_alpha_and_rotation) {
    for (const float x : position_and_scale) file.put(x);
    for (const int x : color_alpha_and_rotation) file.put(static_cast<std::uint8_t>(x));
    return file;
}

std::string valid_record() {
    bytes file;
    return put_record(file, {1, 2, 3, 0.5f, 1, 2}, {0, 128, 255, 64, 255, 128, 128, 128}).data();
}

gs::gaussians plain(std::size_t count) {
    gs::gaussians model;
    model.mean.assign(3 * count, 0.0f);
    model.log_scale.assign(3 * count, 0.0f);
    model.opacity.assign(count, 0.0f);
    model.sh_constant.assign(3 * count, 0.0f);
    for (std::size_t i = 0; i < count; ++i) model.quaternion.insert(model.quaternion.end(), {1, 0, 0, 0});
    return model;
}

}  // namespace

TEST_CASE("writers: a .splat file has the bytes of its layout") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    gs::gaussians model = plain(1);
    model.mean = {1.5f, -2, 3e6f};
    model.log_scale = {0, -104, 1};  // the second is a denormal number
    model.quaternion = {0, 3, 0, -4};
    model.opacity = {1};
    model.sh_constant = {gs::sh_from_color(0.25f), gs::sh_from_color(-1), gs::sh_from_color(2)};
    gs::write_splat(file, model);
    bytes expected;
    // 255 / (1 + e^-1) = 186.4; 128 + 128 * 3 / 5 = 204.8; 128 - 128 * 4 / 5 = 25.6
    put_record(expected, {1.5f, -2, 3e6f, 1, std::exp(-104.0f), std::exp(1.0f)},
               {64, 0, 255, 186, 128, 205, 128, 26});
    CHECK(read_file(file) == expected.data());
}

TEST_CASE("writers: a rotation by -1 and +1 stays within a byte") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    gs::gaussians model = plain(1);
    for (const float w : {1.0f, -1.0f}) {
        model.quaternion[0] = w;
        gs::write_splat(file, model);
        CHECK(static_cast<std::uint8_t>(read_file(file).at(28)) == (w > 0 ? 255 : 0));
    }
}

TEST_CASE("writers: Gaussians of a .splat file are sorted by opacity times volume, ties by index") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    gs::gaussians model = plain(5);
    for (std::size_t i = 0; i < 5; ++i) model.mean[3 * i] = static_cast<float>(i);
    model.log_scale[3 * 1] = 1;  // twice: e times the volume
    model.log_scale[3 * 4 + 2] = 1;
    model.opacity[2] = 1;      // 0.73 instead of 0.5: less than e times
    model.opacity[4] = -1000;  // its logarithm must not overflow
    gs::write_splat(file, model);
    const gs::gaussians read = gs::read_splat(file);
    std::vector<float> order;
    for (std::size_t i = 0; i < 5; ++i) order.push_back(read.mean[3 * i]);
    CHECK(order == std::vector<float>{1, 2, 0, 3, 4});
}

TEST_CASE("writers: a .splat file is read with the precision of its bytes") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    write_file(file, valid_record());
    const gs::gaussians read = gs::read_splat(file);
    REQUIRE(read.count() == 1);
    CHECK(read.sh_degree == 0);
    CHECK(read.mean == std::vector<float>{1, 2, 3});
    CHECK(read.log_scale == std::vector<float>{std::log(0.5f), 0, std::log(2.0f)});
    CHECK(read.quaternion == std::vector<float>{127.0f / 128, 0, 0, 0});
    CHECK(read.opacity[0] == doctest::Approx(std::log(64.0 / 191)));
    CHECK(read.sh_constant[0] == gs::sh_from_color(0));
    CHECK(read.sh_constant[2] == gs::sh_from_color(1));
    gs::write_splat(file, read);
    CHECK(read_file(file) == valid_record());
}

TEST_CASE("writers: each alpha of a .splat file is finite as a logit, and the same byte again") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    for (const int alpha : {0, 1, 127, 254, 255}) {
        CAPTURE(alpha);
        std::string record = valid_record();
        record[27] = static_cast<char>(alpha);
        write_file(file, record);
        const gs::gaussians read = gs::read_splat(file);
        CHECK(std::isfinite(read.opacity[0]));
        const double opacity = 255 / (1 + std::exp(-double(read.opacity[0])));
        CHECK(std::abs(opacity - alpha) < 0.501);
    }
}

TEST_CASE("writers: a flat Gaussian of a .splat file is read with a small finite scale") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    bytes data;
    write_file(file, put_record(data, {0, 0, 0, 1, 1, 0}, {0, 0, 0, 9, 255, 128, 128, 128}).data());
    CHECK(gs::read_splat(file).log_scale[2] == std::log(std::numeric_limits<float>::min()));
}

TEST_CASE("writers: an empty model is an empty .splat file") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    gs::write_splat(file, {});
    CHECK(read_file(file).empty());
    CHECK(gs::read_splat(file).count() == 0);
}

TEST_CASE("writers: a .splat file is not written with values that it cannot hold") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    write_file(file, "old");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto refused = [&](std::vector<float> gs::gaussians::*array, std::size_t place, float value) {
        gs::gaussians model = plain(2);
        (model.*array)[place] = value;
        const std::string problem = error_of([&] { gs::write_splat(file, model); });
        CHECK(read_file(file) == "old");
        const std::string begin = "cannot write " + file.string() + ": the ";
        REQUIRE(problem.starts_with(begin));
        return problem.substr(begin.size());
    };
    CHECK(refused(&gs::gaussians::mean, 5, nan) == "position of Gaussian 1 is not finite");
    CHECK(refused(&gs::gaussians::log_scale, 1, 89) == "scale of Gaussian 0 is not finite");
    CHECK(refused(&gs::gaussians::log_scale, 1, -std::numeric_limits<float>::infinity()) ==
          "scale of Gaussian 0 is not finite");
    CHECK(refused(&gs::gaussians::sh_constant, 4, nan) == "color of Gaussian 1 is not finite");
    CHECK(refused(&gs::gaussians::opacity, 1, nan) == "opacity of Gaussian 1 is not finite");
    CHECK(refused(&gs::gaussians::quaternion, 6, nan) == "rotation of Gaussian 1 is not finite");
    CHECK(refused(&gs::gaussians::quaternion, 0, 0) == "rotation of Gaussian 0 is zero");
}

TEST_CASE("writers: a .splat file that cannot be written is an error, and leaves no part of it") {
    const temporary_folder folder;
    const auto file = folder / "missing" / "a.splat";
    CHECK(error_of([&] { gs::write_splat(file, plain(1)); }) ==
          "cannot write " + file.string() + ": No such file or directory");
    const auto full = folder / "full.splat";
    std::filesystem::create_symlink("/dev/full", full.string() + ".part");
    CHECK(error_of([&] { gs::write_splat(full, plain(1000)); }) ==
          "cannot write " + full.string() + ": No space left on device");
    CHECK_FALSE(std::filesystem::exists(full));
}

TEST_CASE("writers: a malformed .splat file is refused with the Gaussian") {
    const temporary_folder folder;
    const auto file = folder / "a.splat";
    const auto refused = [&](const std::string& second) {
        write_file(file, valid_record() + second);
        const std::string problem = error_of([&] { gs::read_splat(file); });
        REQUIRE(problem.starts_with(file.string() + ": "));
        return problem.substr(file.string().size() + 2);
    };
    CHECK(refused("abc") == "its 35 bytes are no multiple of 32, the size of a Gaussian in a .splat file");
    const float infinity = std::numeric_limits<float>::infinity();
    bytes position, scale, negative, rotation;
    CHECK(refused(put_record(position, {0, infinity, 0, 1, 1, 1}, {0, 0, 0, 9, 255, 128, 128, 128}).data()) ==
          "the position of Gaussian 1 is not finite");
    CHECK(refused(put_record(scale, {0, 0, 0, 1, 1, infinity}, {0, 0, 0, 9, 255, 128, 128, 128}).data()) ==
          "the scale of Gaussian 1 is not finite");
    CHECK(refused(put_record(negative, {0, 0, 0, 1, -1, 1}, {0, 0, 0, 9, 255, 128, 128, 128}).data()) ==
          "the scale of Gaussian 1 is negative");
    CHECK(refused(put_record(rotation, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 9, 128, 128, 128, 128}).data()) ==
          "the rotation of Gaussian 1 is zero");
}
