// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "round_trip.hpp"
#include "scene/look_at.hpp"
#include "writers/html/html.hpp"

namespace {

using gs_test::error_of;
using gs_test::read_file;
using gs_test::says;
using gs_test::temporary_folder;

/// Returns the texts between two marks.
std::vector<std::string> texts_between(const std::string& text, const std::string& before,
                                       const std::string& after) {
    std::vector<std::string> found;
    for (std::size_t at = text.find(before); at != text.npos; at = text.find(before, at)) {
        at += before.size();
        found.push_back(text.substr(at, text.find(after, at) - at));
    }
    return found;
}

std::string bytes_of_base64(const std::string& text) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::size_t bits = 0, count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = (bits << 6 | letters.find(c)) & 0xffffff;
        count += 6;
        if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
    }
    return bytes;
}

nlohmann::json scene_in(const std::string& page) {
    return nlohmann::json::parse(texts_between(page, "id=\"scene\">", "</script>").at(0));
}

/// Returns the model that a page shows.
gs::gaussians model_in(const std::string& page, const temporary_folder& folder) {
    std::string bytes;
    for (const std::string& part : texts_between(page, "class=\"splat\">", "</script>"))
        bytes += bytes_of_base64(part);
    gs_test::write_file(folder / "embedded.compressed.ply", bytes);
    return gs::read_model(folder / "embedded.compressed.ply");
}

gs::pages::viewer_scene plain_scene() {
    gs::pages::viewer_scene scene;
    scene.views = {gs::look_at({0, 0, -4}, {0, 0, 0}, {0, -1, 0}, 100, 120)};
    return scene;
}

}  // namespace

TEST_CASE("writers: a page contains the compressed model") {
    const temporary_folder folder;
    gs::gaussians model = gs_test::random_model(700, 2);
    model.antialiased = true;
    model.sky.assign(gs::sky_width, 0.25f);
    gs::write_model(folder / "a.html", model);
    gs::write_model(folder / "a.compressed.ply", model);
    const std::string page = read_file(folder / "a.html");
    const gs::gaussians shown = model_in(page, folder),
                        expected = gs::read_model(folder / "a.compressed.ply");
    CHECK(shown.mean == expected.mean);
    CHECK(shown.sh_rest == expected.sh_rest);
    CHECK(shown.opacity == expected.opacity);
    const nlohmann::json scene = scene_in(page);
    CHECK(scene["antialiased"] == true);
    CHECK(scene["sky"].size() == gs::sky_width);
    CHECK(scene["gaussians"] == 700);
    CHECK(page.find("http:") == page.npos);
    CHECK(page.find("https:") == page.npos);
}

TEST_CASE("writers: a page of several parts of base64 contains the whole model") {
    const temporary_folder folder;
    const gs::gaussians model = gs_test::random_model(70000, 3);
    gs::write_model(folder / "a.html", model);
    const std::string page = read_file(folder / "a.html");
    CHECK(texts_between(page, "class=\"splat\">", "</script>").size() == 2);
    gs::write_model(folder / "a.compressed.ply", model);
    model_in(page, folder);
    CHECK(read_file(folder / "embedded.compressed.ply") == read_file(folder / "a.compressed.ply"));
}

TEST_CASE("writers: the first view of a page without cameras sees the model from outside") {
    const temporary_folder folder;
    gs::write_model(folder / "a.html", gs_test::random_model(500, 0));
    const nlohmann::json scene = scene_in(read_file(folder / "a.html"));
    REQUIRE(scene["views"].size() == 1);
    const nlohmann::json& view = scene["views"][0];
    double ahead = 0, distance = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double to_pivot = scene["pivot"][k].get<double>() - view["position"][k].get<double>();
        ahead += view["axes"][2][k].get<double>() * to_pivot;
        distance = std::hypot(distance, to_pivot);
    }
    CHECK(ahead == doctest::Approx(distance));
    CHECK(ahead > 2 * std::sqrt(3.0));  // positions are from -2 to 2
}

TEST_CASE("writers: --max-sh-degree limits the model of a page") {
    const temporary_folder folder;
    gs::write_model(folder / "a.html", gs_test::random_model(50, 3), {.max_sh_degree = 1});
    CHECK(model_in(read_file(folder / "a.html"), folder).sh_degree == 1);
}

TEST_CASE("writers: a page above its size limit shows the most important Gaussians") {
    const temporary_folder folder;
    gs::gaussians model = gs_test::random_model(20000, 1);
    for (std::size_t i = 0; i < model.count(); ++i) model.opacity[i] = i % 2 == 0 ? 3.0f : -30.0f;
    constexpr std::uint64_t limit = 260'000;
    std::string message;
    gs::write_viewer(folder / "viewer.html", model, plain_scene(), limit,
                     [&](const std::string& line) { message += line; });
    const std::string page = read_file(folder / "viewer.html");
    CHECK(page.size() <= limit);
    CHECK(page.size() > limit - 10'000);
    const gs::gaussians shown = model_in(page, folder);
    CHECK(says(message,
               {"viewer.html", std::to_string(shown.count()) + " most important of 20000", "--viewer-size"}));
    CHECK(scene_in(page)["gaussians"] == 20000);
    for (const float opacity : shown.opacity) CHECK(opacity > 0);
}

TEST_CASE("writers: a page of a whole model needs no message") {
    const temporary_folder folder;
    std::string message;
    gs::write_viewer(folder / "viewer.html", gs_test::random_model(100, 0), plain_scene(), 64'000'000,
                     [&](const std::string& line) { message += line; });
    CHECK(message.empty());
    CHECK(model_in(read_file(folder / "viewer.html"), folder).count() == 100);
}

TEST_CASE("writers: text in a page is escaped") {
    const temporary_folder folder;
    gs::pages::viewer_scene scene = plain_scene();
    scene.title = "</title><script>alert('x')</script>";
    gs::write_viewer(folder / "viewer.html", gs_test::random_model(3, 0), scene, 1'000'000, {});
    const std::string page = read_file(folder / "viewer.html");
    CHECK(page.find("alert('x')") == page.npos);
    CHECK(page.find("&lt;script&gt;alert") != page.npos);
}

TEST_CASE("writers: a page that cannot be written leaves no file") {
    const temporary_folder folder;
    gs::gaussians model = gs_test::random_model(10, 0);
    model.mean[4] = std::numeric_limits<float>::infinity();
    const std::string message = error_of([&] { gs::write_model(folder / "a.html", model); });
    CHECK(says(message, {"a.html", "finite"}));
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("writers: pages cannot be read") {
    CHECK(says(error_of([] { gs::read_model("a.html"); }), {"HTML files can only be written"}));
}

TEST_CASE("writers: the up direction is perpendicular to the horizontal axes of tilted cameras") {
    gs::scene scene;
    for (const double angle : {0.0, 0.5, 1.0, 1.5}) {
        gs::view& view = scene.train.emplace_back();
        // Cameras on an arc look down at the origin; z is up.
        view.camera =
            gs::look_at({4 * std::cos(angle), 4 * std::sin(angle), 3}, {0, 0, 0}, {0, 0, 1}, 100, 120);
    }
    scene.normalization = {{1, 2, 3}, 2};
    const gs::pages::viewer_scene shown = gs::viewer_scene_of(scene, "arc", {});
    CHECK(shown.up.z > 0.999);
    CHECK(shown.views.size() == 4);
    CHECK(shown.pivot.x == doctest::Approx(1));  // of the world
    CHECK(shown.pivot.z == doctest::Approx(3));
    CHECK(shown.views[0].center().x == doctest::Approx(9));
    CHECK(shown.near_plane == doctest::Approx(0.3));
}
