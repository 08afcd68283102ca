// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "device/cpu/cpu.hpp"  // before kernels, which call functions of its SIMD values
#include "features/exposure/exposures.hpp"
#include "features/resolve.hpp"
#include "features/sh_degree/sh_degree_feature.hpp"
#include "readers/load_scene.hpp"

namespace {

using namespace gs::features;

gs::scene made(const char* parameters) {
    gs::load_options o;
    o.data = std::string("synthetic:") + parameters;
    o.resolution = 2;
    return gs::load_scene(o, {});
}

std::string refusal(const std::string& text) {
    try {
        parse_selection(text);
    } catch (const gs::error& e) {
        return e.what();
    }
    return "";
}

/// The names of the selectable features.
const selected_feature& outcome(const feature_set& features, std::size_t i) {
    REQUIRE(features.all().size() == 11);
    return features.all()[i];
}

/// The initial state of training.
int sh_degree_of(const feature_set& features) {
    const selected_feature& direction = outcome(features, 0);
    const int degree = first_sh_degree(direction.values);
    CHECK(direction.on == (degree > 0));
    return degree;
}

bool revises_sh_degree(const feature_set& features) {
    const std::vector<float>& values = outcome(features, 0).values;
    return values.size() > 1 && values[1] == 1;
}

/// The factor of each photo, which is the same for all channels; none without the feature.
std::vector<float> gains_of(const feature_set& features) {
    std::vector<float> gains;
    for (const exposure& e : exposures_from(features.values_if_on("exposure"))) {
        const float x = e[0];
        CHECK(e == exposure{x, 0, 0, 0, 0, x, 0, 0, 0, 0, x, 0});
        gains.push_back(x);
    }
    return gains;
}

}  // namespace

TEST_CASE("a response without exposures is left out, unless it is named") {
    gs::load_options o;
    o.data = "synthetic:spheres,exposure=0.5,response=0.8";
    const gs::scene scene = gs::load_scene(o, {});
    const auto has = [&](const char* selection) {
        return resolve(scene, parse_selection(selection)).is_on("response");
    };
    CHECK(has("auto"));
    CHECK(!has("auto,-exposure"));
    CHECK(has("auto,-exposure,+response"));
    CHECK(has("all"));
    CHECK(!has("all,-exposure"));
    CHECK(has("response"));
}

TEST_CASE("long: training simulates the recommended effects, or those that --effects names") {
    const gs::scene spheres = made("spheres"), glossy = made("spheres,gloss=0.6,exposure=0.3");
    const auto simulated = [](const gs::scene& scene, const char* selection, std::optional<int> degree = {}) {
        return resolve(scene, parse_selection(selection),
                       degree ? std::vector{explicit_sh_degree(*degree)} : std::vector<selected_feature>{});
    };
    const feature_set matte = simulated(spheres, "auto");
    CHECK(sh_degree_of(matte) == 0);
    CHECK(revises_sh_degree(matte));
    CHECK(gains_of(matte).empty());
    CHECK_FALSE(matte.is_on("antialiasing"));
    REQUIRE(matte.all().size() == 11);
    for (std::size_t i = 0;
         const char* name : {"direction", "vignetting", "exposure", "response", "antialiasing", "sky",
                             "poses", "motion", "moving", "masks", "depth"}) {
        CHECK(matte.all()[i].name == name);
        CHECK_FALSE(matte.all()[i++].on);
    }
    CHECK(outcome(matte, 2).reason.find("the brightness of the same points differs") != std::string::npos);

    const feature_set much = simulated(glossy, "auto,-exposure,+antialiasing");
    CHECK(sh_degree_of(much) > 0);
    CHECK(revises_sh_degree(much));
    CHECK(gains_of(much).empty());
    CHECK(outcome(much, 2).reason == "--effects auto,-exposure,+antialiasing");
    CHECK(much.is_on("antialiasing"));
    const feature_set exposed = simulated(glossy, "auto,-direction");
    CHECK(sh_degree_of(exposed) == 0);
    CHECK_FALSE(revises_sh_degree(exposed));
    CHECK(std::ranges::max(gains_of(exposed)) > 1.2f);
    CHECK(std::ranges::min(gains_of(exposed)) < 0.8f);

    CHECK(sh_degree_of(simulated(spheres, "all")) == 3);
    CHECK(gains_of(simulated(spheres, "all")) == std::vector<float>(48, 1.0f));
    CHECK_FALSE(revises_sh_degree(simulated(spheres, "all")));
    CHECK(sh_degree_of(simulated(glossy, "none")) == 0);
    CHECK(sh_degree_of(simulated(spheres, "+direction,-exposure,-antialiasing,-sky,-masks,-depth")) == 3);
    const feature_set listed = simulated(spheres, "exposure,direction");
    CHECK_FALSE(gains_of(listed).empty());
    CHECK(sh_degree_of(listed) == 3);
    CHECK_FALSE(listed.is_on("antialiasing"));
    CHECK(sh_degree_of(simulated(glossy, "auto", 1)) == 1);
    CHECK_FALSE(outcome(simulated(glossy, "auto", 0), 0).on);
    const feature_set settled =
        simulated(spheres, "auto,-exposure,-antialiasing,-sky,-masks,-depth", 2);  // nothing to look for
    CHECK(sh_degree_of(settled) == 2);
    CHECK_FALSE(revises_sh_degree(settled));
    CHECK(outcome(settled, 0).reason == "--sh-degree 2");

    const feature_set under_sky = simulated(made("spheres,sky=0.7"), "auto");
    CHECK(outcome(under_sky, 5).on);
    CHECK(under_sky.values_if_on("sky").size() == gs::sky_width);
    CHECK(std::abs(under_sky.values_if_on("sky")[0]) > 0.1f);
    CHECK(matte.values_if_on("sky").empty());
    CHECK(simulated(spheres, "all").values_if_on("sky") == std::vector<float>(gs::sky_width, 0.0f));
    CHECK(simulated(made("alpha"), "all").values_if_on("sky").empty());
    CHECK(outcome(simulated(made("alpha"), "all"), 5).reason == "photos have transparent parts");
    CHECK(outcome(simulated(spheres, "all"), 9).reason == "no training photo has masked pixels");
    const feature_set masked = simulated(made("spheres,passers=0.1"), "auto");
    CHECK(outcome(masked, 9).on);
    CHECK(outcome(masked, 9).reason.starts_with("48 of 48 photos have masks, which exclude "));

    CHECK(outcome(simulated(spheres, "all"), 10).reason == "no training photo has a depth map");
    CHECK(simulated(spheres, "all").values_if_on("depth").empty());
    const gs::scene estimated = made("spheres,views=4,points=1000,depths=0.02");
    CHECK(simulated(estimated, "none").values_if_on("depth").empty());
    for (const char* text : {"auto", "depth"}) {
        const feature_set deep = simulated(estimated, text);
        CHECK(outcome(deep, 10).on);
        const std::vector<float> fits = deep.values_if_on("depth");
        REQUIRE(fits.size() == 8);
        for (std::size_t i = 0; i < 8; i += 2) CHECK(fits[i] > 0);
    }
    const feature_set wrong = simulated(made("spheres,views=4,depths=10"), "all");
    CHECK_FALSE(outcome(wrong, 10).on);
    CHECK(outcome(wrong, 10).reason.starts_with(
        "4 of 4 photos have depth maps, of which 0 agree with the points; the median correlation is "));
}

TEST_CASE("a selection of effects that is none is refused") {
    for (const char* text : {"auto", "all", "none", "direction", "exposure,antialiasing", "+direction",
                             "auto,-exposure", "none,+exposure", "all,-direction"}) {
        CAPTURE(text);
        CHECK(refusal(text) == "");
    }
    CHECK(refusal("glare") ==
          "--effects: there is no effect 'glare'; the effects are direction, vignetting, exposure, response, "
          "antialiasing, sky, poses, motion, moving, masks, depth");
    CHECK(parse_selection("auto").allows("masks"));
    CHECK(parse_selection("masks").allows("masks"));
    CHECK_FALSE(parse_selection("none").allows("masks"));
    CHECK_FALSE(parse_selection("all,-masks").allows("masks"));
    CHECK(parse_selection("all,-masks").allows("depth"));
    for (const char* text : {"auto,exposure", "exposure,+direction", "exposure,auto", ""}) {
        CAPTURE(text);
        CHECK(refusal(text).starts_with("--effects"));
    }
}
