// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "pages/base64.hpp"
#include "pages/compare_page.hpp"
#include "pages/inspect_page.hpp"
#include "pages/line_chart.hpp"
#include "pages/page_text.hpp"
#include "pages/picture.hpp"
#include "pages/report_page.hpp"

using namespace gs::pages;
using gs_test::error_of;
using gs_test::says;
using nlohmann::ordered_json;

namespace {

std::string base64_of(const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

gs::image plain_image(int width, int height, float level) {
    return image_of(width, height, std::vector<float>(static_cast<std::size_t>(3 * width * height), level));
}

run_record sample_run(const std::string& name) {
    return {name,
            {{"psnr", 25.5},
             {"gaussians", 1000},
             {"device", "<cpu>"},
             {"seconds", {{"load", 1}, {"train", 3}, {"evaluate", 0}}},
             {"stages", {{"blend_forward", {{"milliseconds", 2}}}}},
             {"history",
              {{"iteration", {100, 200}},
               {"seconds", {1, 3}},
               {"loss", {0.5, nullptr}},
               {"psnr", {20, 25}},
               {"gaussians", {10, 20}}}},
             {"effects", {{{"name", "sky"}, {"on", true}, {"reason", "<b>blue</b>"}}}}},
            {{"data", "/home/someone/photos of <it>/"},
             {"seed", 3},
             {"given",
              {{"data", "/home/someone/photos of <it>/"},
               {"eval", true},
               {"save_iterations", {10, 20}},
               {"resume", false}}}}};
}

std::string page_of(const report& content) {
    std::ostringstream out;
    write_report_page(out, content);
    return out.str();
}

}  // namespace

TEST_CASE("pages: text is escaped for HTML") {
    CHECK(html_escaped("<a href=\"x\">&'") == "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
}

TEST_CASE("pages: JSON cannot end its script element") {
    const std::string text = script_json({{"name", "</script><script>alert(1)</script>\xff"}});
    CHECK(text.find('<') == text.npos);
    CHECK(ordered_json::parse(text)["name"].get<std::string>().starts_with("</script>"));
}

TEST_CASE("pages: parts of a page replace their markers and are not searched for others") {
    std::ostringstream out;
    fill_template(out, "a @x@ b@y@@x@ me@home.org @ c", {{"x", text_part("@y@")}, {"y", text_part("2")}});
    CHECK(out.str() == "a @y@ b2@y@ me@home.org @ c");
}

TEST_CASE("pages: base64 has the letters of RFC 4648") {
    CHECK(base64_of("").empty());
    CHECK(base64_of("f") == "Zg==");
    CHECK(base64_of("fo") == "Zm8=");
    CHECK(base64_of("foobar") == "Zm9vYmFy");
    CHECK(base64_of("\xfb\xff\xfe") == "+//+");
}

TEST_CASE("pages: long base64 is written in parts that decode alone") {
    std::ostringstream out;
    const std::string bytes((3U << 20) + 1, 'f');
    write_base64(
        out, [&](std::ostream& to) { to << bytes; }, "<", ">");
    CHECK(out.str() == "<" + base64_of(bytes.substr(1)) + "><Zg==>");
}

TEST_CASE("pages: a chart shows its points, from zero to round numbers") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::string svg = svg_of({"Loss <1>", "iterations", {{"a", {{50, 4}, {70, nan}, {100, 8}}}}, true});
    // The plot is from x = 50 to 408 and from y = 192 at zero to 28.
    CHECK(svg.find("points=\"229.0,110.0 408.0,28.0\"") != svg.npos);
    CHECK(svg.find("Loss &lt;1&gt;") != svg.npos);
    CHECK(svg.find("legend") == svg.npos);
    CHECK(svg_of({"Empty", "iterations", {{"a", {}}}}).empty());
}

TEST_CASE("pages: a single point in a chart is a line without length") {
    const std::string svg = svg_of({"PSNR", "iterations", {{"a", {{100, 4}}}}, true});
    CHECK(svg.find("points=\"408.0,28.0 408.0,28.0\"") != svg.npos);
}

TEST_CASE("pages: a chart of several runs has a legend") {
    const std::string svg = svg_of({"PSNR", "s", {{"one", {{0, 1}, {1, 2}}}, {"two", {{0, 1}, {1, 3}}}}});
    CHECK(says(svg, {"curve0", "curve1", "key1\">two</span>"}));
}

TEST_CASE("pages: numbers are short") {
    CHECK(short_number(0.25) == "0.25");
    CHECK(short_number(12000) == "12k");
    CHECK(short_number(1.25e6) == "1.25M");
}

TEST_CASE("pages: the error of equal images is black, and a large one is bright") {
    const gs::image a = plain_image(2, 1, 0.5F), b = plain_image(2, 1, 1);
    CHECK(error_image(a, a, "v").rgba[0] == 0);
    CHECK(error_image(a, b, "v").rgba[0] == 252);
    CHECK(says(error_of([&] { error_image(a, plain_image(1, 1, 0), "name"); }), {"name", "size"}));
}

TEST_CASE("pages: images are JPEGs in data URLs of bounded size") {
    gs_test::temporary_folder folder;
    CHECK(data_url(plain_image(3, 2, 1)).starts_with("data:image/jpeg;base64,/9j/"));
    CHECK(data_url(plain_image(4000, 10, 1)).size() < 20000);
}

TEST_CASE("pages: a thumbnail is small and opaque, with patterns for what is not part of the photo") {
    gs::image photo = plain_image(4, 1, 0.5F);
    for (std::size_t c = 0; c < 4; ++c) photo.rgba[4 + c] = 0;
    photo.has_alpha = true;
    photo.mask_pixel(2);
    const gs::image shown = thumbnail(photo);
    CHECK(int{shown.rgba[0]} == 128);
    CHECK(int{shown.rgba[4]} == 150);
    CHECK(int{shown.rgba[8]} == 255);
    CHECK(int{shown.rgba[9]} == 0);
    for (std::size_t i = 0; i < 4; ++i) CHECK(int{shown.rgba[4 * i + 3]} == 255);
    CHECK_FALSE(shown.has_alpha);
    CHECK_FALSE(shown.has_mask);
    CHECK(thumbnail(plain_image(20, 2000, 1)).height == 640);
    CHECK(thumbnail(plain_image(20, 2000, 1)).width == 6);
}

TEST_CASE("pages: the report escapes texts and shows no folders") {
    const std::string page = page_of({sample_run("<script>alert(1)</script>"), {}, true});
    CHECK(page.find("<script>alert") == page.npos);
    CHECK(page.find("<b>blue") == page.npos);
    CHECK(page.find("someone") == page.npos);
    CHECK(says(page, {"&lt;b&gt;blue", "25.50", "blend forward", "&lt;cpu&gt;"}));
}

TEST_CASE("pages: the report gives the command with the options of the user") {
    CHECK(command_of(sample_run("a").settings) ==
          "gaussian_splatting train --data 'photos of <it>' --eval --save-iterations 10 20");
    CHECK(command_of({{"given", {{"output", "it's"}}}}) == "gaussian_splatting train --output 'it'\\''s'");
}

TEST_CASE("pages: the report labels training views as such") {
    const view_images view{"a.jpg", "Worst view", 20.25, plain_image(4, 4, 0), plain_image(4, 4, 1)};
    const std::string training = page_of({sample_run("a"), {view}, false}),
                      held_out = page_of({sample_run("a"), {view}, true});
    CHECK(says(training, {"<b>training views</b>", "--eval", "Worst view</b> a.jpg, 20.25 dB"}));
    CHECK(held_out.find("<b>training views</b>") == held_out.npos);
    CHECK(says(held_out, {"held out"}));
}

TEST_CASE("pages: names of views have no folders outside of the scene") {
    const auto caption = [](const std::string& name) {
        const view_images view{name, "Worst view", 20.25, plain_image(4, 4, 0), plain_image(4, 4, 1)};
        const std::string page = page_of({sample_run("a"), {view}, false});
        const std::string begin = "Worst view</b> ";
        const auto at = page.find(begin) + begin.size();
        return page.substr(at, page.find(',', at) - at);
    };
    CHECK(caption("left/a.jpg") == "left/a.jpg");
    CHECK(caption("/home/someone/a.jpg") == "a.jpg");
    CHECK(caption("../someone/a.jpg") == "a.jpg");
}

TEST_CASE("pages: the report ignores values of wrong types") {
    const run_record broken{
        "a",
        {{"psnr", "x"}, {"history", {1}}, {"effects", {1, {{"on", 2}}}}, {"stages", {1}}, {"seconds", 4}},
        ordered_json::object()};
    CHECK(page_of({broken, {}, false}).find("too short for curves") != std::string::npos);
}

TEST_CASE("pages: typical views are the worst, the median and the best") {
    const auto chosen = typical_views({30, 10, 20, 50, 40});
    REQUIRE(chosen.size() == 3);
    CHECK(chosen[0].first == 1);
    CHECK(chosen[1].first == 0);
    CHECK(chosen[2].first == 3);
    CHECK(typical_views({1}).size() == 1);
    CHECK(typical_views({}).empty());
}

TEST_CASE("pages: a comparison marks the best value and the settings that differ") {
    run_record a = sample_run("a"), b = sample_run("<b>");
    b.metrics["psnr"] = 26;
    b.settings["seed"] = 4;
    std::ostringstream out;
    write_compare_page(
        out, {a, b},
        {{"v", "Worst view", plain_image(2, 2, 0), {plain_image(2, 2, 1), plain_image(2, 2, 0.5F)}}});
    const std::string page = out.str();
    CHECK(says(page, {"<td>25.50</td><td class=\"best\">26.00</td>",
                      "<tr class=\"differs\"><th>seed</th><td>3</td><td>4</td></tr>", "&lt;b&gt;",
                      "<option selected>a</option>"}));
    CHECK(page.find("class=\"differs\"><th>data") == page.npos);
    CHECK(page.find("someone") == page.npos);
    CHECK(page.find("<b>") == page.find("<b>Worst view"));
}

namespace {

inspected_effect sample_effect() {
    return {.name = "sky",
            .recommended = true,
            .evidence = "40 % <blue>",
            .condition = "at least 2 % & more",
            .choice = "on",
            .costs_and_gains = "removes floaters",
            .overruled_by = {"--effects auto,-sky"},
            .obstacle = "",
            .charts = {{"Area <1>", "photo", {{"sky", {{1, 2}, {2, 3}}}}, true}},
            .photos = {{.label = "Most sky",
                        .name = "/home/someone/<a>.jpg",
                        .note = "Blue: \"sky\"",
                        .pixels = plain_image(4, 2, 1),
                        .width = 400,
                        .height = 200,
                        .marks = {{10, 20, 30, 40}, {100, 50, 0, 0, 1}}}}};
}

std::string page_of(const std::vector<inspected_effect>& effects) {
    std::ostringstream out;
    write_inspect_page(out, {"<garden>", 12, effects});
    return out.str();
}

}  // namespace

TEST_CASE("pages: evidence has the decision, its condition, and the option that overrules it") {
    inspected_effect effect = sample_effect();
    const std::string page = page_of({effect});
    CHECK(says(page,
               {"<title>Effects of &lt;garden&gt;</title>", "Training photos: 12", "<a href=\"#sky\">sky</a>",
                "<section class=\"evidence\" id=\"sky\">", "class=\"verdict yes\">recommended<",
                "40 % &lt;blue&gt;", "Recommended if</th><td>at least 2 % &amp; more</td>",
                "<code>--effects auto,-sky</code>", "removes floaters", "Area &lt;1&gt;"}));
    effect.recommended = false;
    effect.overruled_by = {"--effects auto,+sky"};
    CHECK(says(page_of({effect}), {">not recommended<", "<code>--effects auto,+sky</code>"}));
    effect.obstacle = "no <sky>";
    const std::string impossible = page_of({effect});
    CHECK(says(impossible, {"cannot be trained with the effect: no &lt;sky&gt;"}));
    CHECK(impossible.find("<code>--effects") == impossible.npos);
    effect.recommended.reset();
    CHECK(says(page_of({effect}), {">cannot decide<"}));
    effect.obstacle.clear();
    effect.overruled_by.clear();
    CHECK(says(page_of({effect}), {"No option; the files of the scene decide"}));
}

TEST_CASE("pages: marks of a photo have its coordinates, and its name has no folders") {
    const std::string page = page_of({sample_effect()});
    CHECK(says(page,
               {"<svg viewBox=\"0 0 400 200\"",
                "<rect x=\"10\" y=\"20\" width=\"30\" height=\"40\" class=\"mark0\"/>",
                "<circle r=\"8.0\" cx=\"100\" cy=\"50\" class=\"mark1\"/>",
                "<b>Most sky</b> &lt;a&gt;.jpg<br>Blue: &quot;sky&quot;", "src=\"data:image/jpeg;base64,"}));
    CHECK(page.find("someone") == page.npos);
    for (const char* foreign : {"http:", "https:", "<script", "url("}) {
        CAPTURE(foreign);
        CHECK(page.find(foreign) == page.npos);
    }
}
