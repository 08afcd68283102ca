// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "decide.hpp"

#include <cmath>
#include <cstdio>

namespace gs::effects {
namespace {

/// From which evidence on an effect is called for.
constexpr struct {
    std::size_t points = 50;             ///< fewer of them say nothing
    std::size_t some_points = 10;        ///< fewer of them are next to none
    double direction_share = 0.03;       ///< of the mean square that is unexplained, for each further degree
    double direction_amplitude = 0.002;  ///< and this root mean square, of full brightness
    double exposure = 0.1;               ///< see `evidence::exposure_spread`
    double exposure_errors = 3;          ///< times its standard error
    double scale_ratio = 2;
    double sky_share = 0.02;       ///< of the photos' area
    double sky_of_empty = 0.5;     ///< and of what is smooth and without points
    double sky_brightness = 0.08;  ///< what is darker is as well black
    double depth_photos = 0.5;     ///< of those with depth maps
} limits;

template <class... Values>
std::string text(const char* format, Values... values) {
    char line[200];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

std::string too_few(std::size_t points, const char* where) {
    return text("no telling: %zu points lie %s of 5 photos or more", points, where);
}

/// What each costs and gains: docs/effects.md.
namespace expected {
constexpr const char* direction =
    "5 % of an iteration and 45 floats a Gaussian for degree 3; 1 dB on glossy scenes, -0.2 dB on noisy "
    "matte ones";
constexpr const char* exposure =
    "up to 8 % of an iteration; 6 dB where photos differ by a fifth, after fitting";
constexpr const char* antialiasing = "no time; 1 to 7 dB from other distances, -0.7 dB where all are alike";
constexpr const char* sky =
    "2 to 15 % of an iteration; 4 dB where a third of the photos is sky, 0.5 dB on photos";
constexpr const char* masks = "no time; 2 dB where a tenth of each photo is something that passed";
constexpr const char* lens = "3 % of an iteration; without, photos as wide as a hemisphere are of no use";
constexpr const char* depth =
    "35 to 90 % of an iteration; up to 1 dB where photos and points are few, else nothing";
constexpr const char* background = "nothing";
}  // namespace expected

decision direction(const evidence& e) {
    const int degree = sh_degree(e);
    const std::string choice = "--sh-degree " + std::to_string(degree);
    if (!direction_is_known(e))
        return {"direction",
                {},
                too_few(e.direction_points, "about as large in smooth parts"),
                choice,
                expected::direction};
    const auto up_to = static_cast<std::size_t>(degree == 0 ? 3 : degree);
    return {"direction", degree > 0,
            text("degree %zu brings what photos of a point differ by from %.2f %% down to %.2f %%", up_to,
                 100 * std::sqrt(e.unexplained[0]), 100 * std::sqrt(e.unexplained[up_to])),
            choice, expected::direction};
}

decision exposure(const evidence& e) {
    if (e.exposure_points < limits.points)
        return {"exposure", {}, too_few(e.exposure_points, "in smooth parts"), "off", expected::exposure};
    const bool varies = e.exposure_spread >= limits.exposure &&
                        e.exposure_spread >= limits.exposure_errors * e.exposure_error;
    const auto percent = [](double log2) { return 100 * (std::exp2(log2) - 1); };
    return {"exposure", varies,
            text("photos have the same points %.1f %% brighter or darker, measured to %.1f %%",
                 percent(e.exposure_spread), percent(e.exposure_error)),
            varies ? "on" : "off", expected::exposure};
}

decision antialiasing(const evidence& e) {
    if (e.scale_points < limits.points)
        return {"antialiasing", {}, too_few(e.scale_points, "in sight"), "off", expected::antialiasing};
    const bool spreads = e.scale_ratio >= limits.scale_ratio;
    return {"antialiasing", spreads,
            text("the median point is %.1f times as large in one photo as in another", e.scale_ratio),
            spreads ? "on" : "off", expected::antialiasing};
}

decision sky(const evidence& e) {
    const sky_evidence& s = e.sky;
    if (!s.is_asked) return {"sky", {}, "no telling: the scene has no points", "off", expected::sky};
    if (e.alpha) return {"sky", false, "photos have transparent parts", "off", expected::sky};
    const bool is_there = s.share >= limits.sky_share && s.share >= limits.sky_of_empty * s.empty &&
                          s.brightness >= limits.sky_brightness;
    return {
        "sky", is_there,
        text("%.1f %% of the photos' area is smooth and without points; of that, other photos tell %.0f %%, "
             "%.0f %% bright, by direction",
             100 * s.empty, s.empty > 0 ? 100 * s.share / s.empty : 0.0, 100 * s.brightness),
        is_there ? "on" : "off", expected::sky};
}

decision masks(const evidence& e) {
    const bool some = e.masked_photos > 0;
    return {"masks", some,
            some ? text("%zu of %zu photos have masks, which leave out %.1f %% of all pixels",
                        e.masked_photos, e.photos, 100 * e.masked_share)
                 : no_masks,
            some ? "on" : "off", expected::masks};
}

decision depth(const evidence& e) {
    const depth_evidence& d = e.depth;
    const bool agree = d.agreeing > 0 && static_cast<double>(d.agreeing) >=
                                             limits.depth_photos * static_cast<double>(d.with_map);
    std::optional<bool> called_for = agree;
    if (d.with_map > 0 && d.told == 0) called_for.reset();
    return {"depth", called_for, say(d), agree ? "on" : "off", expected::depth};
}

decision background(const evidence& e) {
    return {"background", e.alpha, e.alpha ? "photos have transparent parts" : "all photos are opaque",
            e.alpha ? "white" : "black", expected::background};
}

decision lens(const evidence& e) {
    const bool bent = e.fisheye_photos > 0;
    return {"lens", bent,
            bent ? text("fisheye lenses took %zu of %zu photos, up to %.0f degrees from corner to corner",
                        e.fisheye_photos, e.photos, e.widest)
                 : "all cameras are pinhole cameras, or their photos were undistorted",
            bent ? "drawn in place" : "pinhole", expected::lens};
}

}  // namespace

bool direction_is_known(const evidence& e) { return e.direction_points >= limits.points; }

int sh_degree(const evidence& e) {
    if (!direction_is_known(e)) return e.has_points && e.direction_points < limits.some_points ? 0 : 3;
    std::size_t degree = 0;
    for (std::size_t d = 1; d < e.unexplained.size(); ++d) {
        const double gone = e.unexplained[degree] - e.unexplained[d];
        const double amplitude = limits.direction_amplitude;
        if (gone >= limits.direction_share * e.unexplained[0] && gone >= amplitude * amplitude) degree = d;
    }
    return static_cast<int>(degree);
}

std::vector<decision> decide(const evidence& e) {
    return {direction(e), exposure(e), antialiasing(e), sky(e), masks(e), depth(e), lens(e), background(e)};
}

}  // namespace gs::effects
