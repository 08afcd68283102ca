// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// What all formats have in common. A test that a format keeps its parameters needs one row here.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "round_trip.hpp"
#include "writers/compressed_ply/compressed_ply.hpp"
#include "writers/gltf/gltf.hpp"
#include "writers/ply/ply.hpp"
#include "writers/sog/sog.hpp"
#include "writers/splat/splat.hpp"
#include "writers/spz/spz.hpp"

namespace {

using gs_test::error_of;
using gs_test::precision;
using gs_test::random_model;
using gs_test::read_back;
using gs_test::read_file;
using gs_test::temporary_folder;
using gs_test::write_file;

/// A format, and the half steps of its quantization.
struct format_precision {
    const gs::writer& format;
    precision bound;
};

constexpr double byte_step = 1.0 / 255;

std::vector<format_precision> formats() {
    return {
        {gs::ply_writer, {0, 0, 1e-7, 0, 0, 0}},
        {gs::splat_writer, {0, 1e-6, 1.0 / 128, 0.5 * byte_step + 1e-6, 0.5 * byte_step / 0.28 + 1e-5, 0}},
        {gs::compressed_ply_writer,
         {2.0 / 1023 + 1e-6, 2.5 / 1023 + 1e-6, 0.0021, 0.5 * byte_step + 1e-6, 0.5 * byte_step / 0.28,
          1.0 / 64 + 1e-6}},
        {gs::spz_writer,
         {0.5 / 4096 + 1e-6, 0.5 / 16 + 1e-6, 0.0021, 0.5 * byte_step + 1e-6, 0.5 * byte_step / 0.15 + 1e-6,
          1.0 / 128 + 1e-6}},
        {gs::gltf_writer, {0, 1e-6, 1e-6, 1.1e-7, 0, 0}},
        // The values fill ranges of 5, 3.54 and 1 evenly, but at random. A range of 256 in the codebook may
        // therefore be wider than the mean one, up to twice. test_sog.cpp uses the ranges of the file.
        {gs::sog_writer, {6e-5, 5.0 / 256, 0.0081, 0.5 * byte_step + 1e-6, 3.54 / 256, 1.0 / 256}},
    };
}

void for_each_format(const auto& check) {
    for (const format_precision& one : formats()) {
        CAPTURE(one.format.name);
        check(one.format, one.bound);
    }
}

/// Returns the model without the SH degrees that a format does not hold.
gs::gaussians without_sh_above(gs::gaussians model, int degree) {
    if (model.sh_degree <= degree) return model;
    const auto before = static_cast<std::size_t>(model.rest_width());
    model.sh_degree = degree;
    const auto width = static_cast<std::size_t>(model.rest_width());
    std::vector<float> rest;
    for (std::size_t i = 0; i < model.count(); ++i)
        for (std::size_t k = 0; k < width; ++k) rest.push_back(model.sh_rest[i * before + k]);
    model.sh_rest = rest;
    return model;
}

}  // namespace

TEST_CASE("writers: the table of precisions has every format that can be read") {
    for (const gs::writer* one : gs::all_writers()) {
        CAPTURE(one->name);
        if (one->read)
            CHECK(std::ranges::any_of(formats(), [&](const auto& row) { return &row.format == one; }));
    }
}

TEST_CASE("writers: each format keeps 0, 1, 256 and 257 Gaussians of each SH degree within its precision") {
    for_each_format([](const gs::writer& format, const precision& bound) {
        for (const std::size_t count : {0, 1, 256, 257})
            for (int degree = 0; degree <= 3; ++degree) {
                CAPTURE(count);
                CAPTURE(degree);
                const gs::gaussians model = random_model(count, degree);
                check_same_gaussians(without_sh_above(model, format.max_sh_degree), read_back(format, model),
                                     bound);
            }
    });
}

TEST_CASE("writers: each format drops SH coefficients above --max-sh-degree") {
    for_each_format([](const gs::writer& format, const precision& bound) {
        for (int degree = 0; degree <= 3; ++degree) {
            CAPTURE(degree);
            const gs::gaussians model = random_model(40, 3);
            check_same_gaussians(without_sh_above(model, std::min(degree, format.max_sh_degree)),
                                 read_back(format, model, {.max_sh_degree = degree}), bound);
        }
    });
}

TEST_CASE("writers: each format names exactly what its files do not give back") {
    for_each_format([](const gs::writer& format, const precision&) {
        gs::gaussians model = random_model(5, 2);
        model.antialiased = true;
        model.sky.assign(gs::sky_width, 0.5f);
        const gs::gaussians found = read_back(format, model);
        const std::string file = "model" + std::string(format.endings[0]);
        std::string all;
        for (const std::string& sentence : gs::left_out(file, model)) all += sentence + "\n";
        CHECK(gs_test::says(all, {"view dependence of colors"}) == (found.sh_degree < 2));
        CHECK(gs_test::says(all, {"antialiasing"}) == !found.antialiased);
        CHECK(gs_test::says(all, {"learned background"}) == found.sky.empty());
        CHECK(gs::left_out(file, random_model(5, 0)).empty());
    });
    const gs::gaussians model = random_model(5, 2);
    CHECK(
        gs::left_out("a.splat", model) ==
        std::vector<std::string>{"a.splat leaves out the view dependence of colors: SPLAT files cannot hold "
                                 "it; .ply files can"});
    CHECK(gs::left_out("a.splat", model, {.max_sh_degree = 0}).empty());
}

TEST_CASE("writers: each format keeps opacities of almost 0 and 1, and reads them as finite logits") {
    for_each_format([](const gs::writer& format, const precision& bound) {
        gs::gaussians model = random_model(3, 0);
        model.opacity = {-80, 80, 0};
        check_same_gaussians(model, read_back(format, model), bound);
    });
}

TEST_CASE("writers: each format reads huge and tiny scales as finite values of the same order") {
    for_each_format([](const gs::writer& format, const precision&) {
        gs::gaussians model = random_model(2, 0);
        std::fill_n(model.log_scale.begin(), 3, -30.0f);
        std::fill_n(model.log_scale.begin() + 3, 3, 30.0f);
        const gs::gaussians found = read_back(format, model);
        REQUIRE(found.count() == 2);
        const float low = std::ranges::min(found.log_scale), high = std::ranges::max(found.log_scale);
        CHECK(std::isfinite(low));
        CHECK(std::isfinite(high));
        CHECK(low <= -9);
        CHECK(high >= 5);
    });
}

TEST_CASE("writers: each format keeps many Gaussians at one place") {
    for_each_format([](const gs::writer& format, const precision&) {
        gs::gaussians model = random_model(300, 1);
        for (std::size_t i = 0; i < model.mean.size(); ++i) model.mean[i] = static_cast<float>(i % 3) - 0.5f;
        const gs::gaussians found = read_back(format, model);
        REQUIRE(found.count() == 300);
        for (std::size_t i = 0; i < found.mean.size(); ++i)
            CHECK(found.mean[i] == doctest::Approx(static_cast<float>(i % 3) - 0.5f).epsilon(0.001));
    });
}

TEST_CASE("writers: no format writes values that are not finite, and an older file stays") {
    const float infinity = std::numeric_limits<float>::infinity();
    for_each_format([&](const gs::writer& format, const precision&) {
        const temporary_folder folder;
        const auto file = folder / ("model" + std::string(format.endings[0]));
        write_file(file, "old");
        for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity})
            for (const auto array :
                 {&gs::gaussians::mean, &gs::gaussians::log_scale, &gs::gaussians::quaternion,
                  &gs::gaussians::opacity, &gs::gaussians::sh_constant, &gs::gaussians::sh_rest}) {
                if (array == &gs::gaussians::sh_rest && format.max_sh_degree == 0) continue;
                gs::gaussians model = random_model(3, 2);
                (model.*array).back() = bad;
                const std::string problem = error_of([&] { format.write(file, model, {}); });
                CHECK(gs_test::says(problem, {file.string(), "2", "finite"}));
                CHECK(read_file(file) == "old");
            }
    });
}

TEST_CASE("writers: a full disk is an error of every format, and no part of a file stays") {
    for_each_format([](const gs::writer& format, const precision&) {
        const temporary_folder folder;
        const auto file = folder / ("model" + std::string(format.endings[0]));
        std::filesystem::create_symlink("/dev/full", file.string() + ".part");
        CHECK(error_of([&] { format.write(file, random_model(3000, 0), {}); }) ==
              "cannot write " + file.string() + ": No space left on device");
        CHECK_FALSE(std::filesystem::exists(file));
    });
}

TEST_CASE("writers: a file of each format that is cut off is refused with its name") {
    for_each_format([](const gs::writer& format, const precision&) {
        const temporary_folder folder;
        const auto file = folder / ("model" + std::string(format.endings[0]));
        format.write(file, random_model(20, 1), {});
        const std::string whole = read_file(file);
        for (std::size_t length = 1; length < whole.size(); length += 1 + whole.size() / 50) {
            if (&format == &gs::splat_writer && length % 32 == 0) continue;  // a shorter valid file
            CAPTURE(length);
            write_file(file, whole.substr(0, length));
            CHECK(error_of([&] { format.read(file); }).starts_with(file.string() + ": "));
        }
    });
}
