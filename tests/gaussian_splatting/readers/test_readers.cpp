// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "known_scene.hpp"
#include "readers/load_scene.hpp"

namespace {

using gs_test::error_of;
using gs_test::options_for;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;

gs::image_record made_image(const std::string& name, bool held_out, std::uint8_t alpha) {
    gs::image_record record;
    record.name = name;
    record.held_out = held_out;
    record.camera.width = record.camera.height = 1;
    record.pixels = {1, 1, {0, 0, 0, alpha}, alpha < 255, false};
    return record;
}

/// A made-up format: a file that ends in ".made". The images are in memory, except for one on disk.
const gs::reader made_up{"made-up", "a file that ends in .made",
                         [](const std::string& data) { return data.ends_with(".made"); },
                         [](const gs::load_options& options, const gs::log_function& log) {
                             log("seed " + std::to_string(options.seed));
                             gs::scene_description result;
                             result.images = {made_image("a", false, 255), made_image("b", true, 10)};
                             result.points = {{{1, 2, 3}, {4, 5, 6}}};
                             const auto file = std::filesystem::path(options.data).parent_path() / "c.png";
                             if (!std::filesystem::exists(file)) return result;
                             gs::image_record on_disk;
                             on_disk.name = "c";
                             on_disk.file = file;
                             on_disk.camera.width = on_disk.camera.height = 2;
                             on_disk.camera.fx = on_disk.camera.fy = 4;
                             result.images.insert(result.images.begin() + 1, on_disk);
                             return result;
                         }};

constexpr gs::reader_option every[] = {gs::test_every_option};

/// Accepts everything, but holds nothing.
const gs::reader greedy{
    "greedy", "anything", [](const std::string&) { return true; },
    [](const gs::load_options&, const gs::log_function&) { return gs::scene_description(); }, every};

constexpr const gs::reader* made_up_first[] = {&made_up, &greedy};
constexpr const gs::reader* greedy_first[] = {&greedy, &made_up};
constexpr const gs::reader* only_made_up[] = {&made_up};

std::string error_of_loading(const gs::load_options& options, std::span<const gs::reader* const> readers) {
    return error_of([&] { gs::load_scene(options, {}, readers); });
}

}  // namespace

TEST_CASE("readers: the first whose probe accepts the scene reads it") {
    CHECK(gs::load_scene(options_for("x.made"), {}, made_up_first).train.size() == 2);
    CHECK(says(error_of_loading(options_for("x.made"), greedy_first), {"x.made", "no training views"}));
}

TEST_CASE("readers: a scene is what its reader describes") {
    gs::load_options options = options_for("x.made");
    options.seed = 7;
    std::string said;
    gs::scene scene = gs::load_scene(
        options, [&](const std::string& line) { said += line; }, only_made_up);
    CHECK(said == "seed 7");
    REQUIRE(scene.train.size() == 2);
    CHECK(scene.test.empty());
    CHECK(scene.train[1].pixels.rgba[3] == 10);
    CHECK(scene.has_alpha);
    CHECK(scene.points.size() == 1);

    options.eval = true;
    scene = gs::load_scene(options, {}, only_made_up);
    REQUIRE(scene.test.size() == 1);
    CHECK(scene.test[0].name == "b");
}

TEST_CASE("readers: images in memory and on disk keep their order, and only those on disk are scaled") {
    const temporary_folder folder;
    gs::write_png(folder / "c.png", 2, 2, std::vector<float>(12, 1.0f));
    gs::load_options options = options_for((folder / "x.made").string());
    options.resolution = 2;
    const gs::scene scene = gs::load_scene(options, {}, only_made_up);
    REQUIRE(scene.train.size() == 3);
    CHECK(scene.train[1].name == "c");
    CHECK(scene.train[1].pixels.width == 1);
    CHECK(scene.train[1].camera.fx == 2);
    CHECK(scene.train[2].name == "b");
    CHECK(scene.train[2].pixels.width == 1);
}

TEST_CASE("readers: a path that no reader accepts is refused with everything that was looked for") {
    const temporary_folder folder;
    const gs::load_options options = options_for((folder / "nothing").string());
    CHECK(error_of_loading(options, only_made_up) ==
          options.data +
              " does not exist; a scene is a file that ends in .made or a .zip archive of such a folder");
    write_file(options.data, "x");
    const std::string refusal = error_of_loading(options, gs::all_readers());
    CHECK(says(refusal, {options.data, "is not a scene"}));
    for (const gs::reader* known : gs::all_readers()) CHECK(says(refusal, {known->name, known->accepts}));
    CHECK(says(error_of_loading(options_for(std::string(5000, 'x')), only_made_up), {"cannot read", "xxx"}));
}

TEST_CASE("readers: an option is refused where only other readers use it") {
    gs::load_options options = options_for("x.made");
    options.test_every = 5;
    CHECK(error_of_loading(options, made_up_first) ==
          "--test-every does not apply to made-up scenes, only to greedy scenes");
    CHECK(says(error_of_loading(options, greedy_first), {"no training views"}));  // its own option
}

TEST_CASE("readers: names are distinct") {
    std::vector<std::string_view> names;
    for (const gs::reader* one : gs::all_readers()) names.push_back(one->name);
    std::ranges::sort(names);
    CHECK(std::ranges::adjacent_find(names) == names.end());
}
