// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "writers/writer.hpp"

namespace {

using gs_test::error_of;
using gs_test::read_file;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;

gs::gaussians sample_model(int sh_degree, std::size_t count) {
    gs::gaussians model;
    model.sh_degree = sh_degree;
    float next = 0;
    const auto fill = [&](std::vector<float>& values, int width) {
        values.resize(count * static_cast<std::size_t>(width));
        for (float& value : values) value = next += 0.25f;
    };
    fill(model.mean, 3);
    fill(model.log_scale, 3);
    fill(model.quaternion, 4);
    fill(model.opacity, 1);
    fill(model.sh_constant, 3);
    fill(model.sh_rest, model.rest_width());
    return model;
}

constexpr std::string_view long_endings[] = {".compressed.ply", ".cply"};
constexpr std::string_view short_endings[] = {".ply"};

/// Made-up formats: the first holds the number of Gaussians, the second cannot be read.
const gs::writer counting{
    "counting", long_endings,
    [](const std::filesystem::path& file, const gs::gaussians& model, const gs::write_options& options) {
        write_file(file, std::to_string(model.count()) + " " + std::to_string(options.max_sh_degree));
    },
    [](const std::filesystem::path& file) { return sample_model(0, std::stoul(read_file(file))); }};
const gs::writer write_only{"write-only", short_endings,
                            [](const std::filesystem::path& file, const gs::gaussians&,
                               const gs::write_options&) { write_file(file, "plain"); }};
constexpr const gs::writer* made_up[] = {&write_only, &counting};

}  // namespace

TEST_CASE("writers: the longest ending chooses the format, in upper or lower case") {
    const temporary_folder folder;
    for (const std::string name : {"a.compressed.ply", "a.b.CPLY", "A.Compressed.Ply"}) {
        CAPTURE(name);
        gs::write_model(folder / name, sample_model(0, 7), {.max_sh_degree = 2}, made_up);
        CHECK(read_file(folder / name) == "7 2");
        CHECK(gs::read_model(folder / name, made_up).count() == 7);
    }
    gs::write_model(folder / "a.ply", sample_model(0, 7), {}, made_up);
    CHECK(read_file(folder / "a.ply") == "plain");
}

TEST_CASE("writers: an unknown ending is refused with the known ones") {
    const temporary_folder folder;
    for (const std::string name : {"model.xyz", "ply", "model", "model.ply.bak"}) {
        CAPTURE(name);
        const std::string file = (folder / name).string();
        CHECK(error_of([&] { gs::write_model(file, sample_model(0, 1), {}, made_up); }) ==
              "cannot write " + file +
                  ": its ending names no known format; known endings are .ply, .compressed.ply and .cply");
        CHECK(error_of([&] { gs::read_model(file, made_up); }) ==
              "cannot read " + file +
                  ": its ending names no known format; known endings are .compressed.ply and .cply");
        CHECK_FALSE(std::filesystem::exists(file));
    }
}

TEST_CASE("writers: a format that can only be written is not read") {
    CHECK(error_of([] { gs::read_model("a.ply", made_up); }) ==
          "cannot read a.ply: write-only files can only be written; the endings of formats that can be read "
          "are .compressed.ply and .cply");
}

TEST_CASE(
    "writers: each readable format keeps the count, and the SH degree up to its own limit and the one asked "
    "for") {
    const temporary_folder folder;
    std::size_t formats = 0;
    for (const gs::writer* format : gs::all_writers()) {
        if (!format->read) continue;
        for (const std::string_view ending : format->endings) {
            CAPTURE(ending);
            const auto file = folder / ("model" + std::string(ending));
            const gs::gaussians model = sample_model(3, 5);
            for (int degree = 0; degree <= 3; ++degree) {
                CAPTURE(degree);
                gs::write_model(file, model, {.max_sh_degree = degree});
                const gs::gaussians read = gs::read_model(file);
                CHECK(read.sh_degree == std::min(degree, format->max_sh_degree));
                REQUIRE(read.count() == model.count());
                CHECK(read.sh_rest.size() == model.count() * static_cast<std::size_t>(read.rest_width()));
            }
            ++formats;
        }
    }
    CHECK(formats > 0);
}

TEST_CASE("writers: no two have the same ending, and all endings are in lower case") {
    std::vector<std::string_view> all;
    for (const gs::writer* format : gs::all_writers())
        all.insert(all.end(), format->endings.begin(), format->endings.end());
    std::ranges::sort(all);
    CHECK(std::ranges::adjacent_find(all) == all.end());
    for (const std::string_view ending : all) {
        CAPTURE(ending);
        CHECK(ending.starts_with('.'));
        CHECK(std::ranges::none_of(ending, [](char c) { return c >= 'A' && c <= 'Z'; }));
    }
}
