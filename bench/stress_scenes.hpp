// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Scenes and schedules that are hard to train on: synthetic:spheres, made hard in one way each.

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "readers/load_scene.hpp"
#include "readers/synthetic/synthetic.hpp"
#include "scene/look_at.hpp"
#include "training/training.hpp"

/// Something to train: at first as it should be, then made hard.
struct trial {
    gs::scene scene;  ///< in coordinates of scale * (x + offset)
    gs::train::schedule schedule;
    gs::train::adaptive_config adaptive;
    std::size_t cap = 0;
    std::uint64_t seed = 0;
    std::size_t large_count = 0;  ///< number of Gaussians, if many of them make the case hard
    int large_iterations = 0;
    glm::dvec3 offset{0};
    double scale = 1;
};

struct hard_case {
    const char* name;
    const char* what;
    std::function<void(trial&)> make;
};

inline void speed_up(gs::train::schedule& s) {
    s.position_lr_init = 10 * s.position_rate_init();
    s.position_lr_final = 10 * s.position_rate_final();
    for (double* rate : {&s.feature_lr, &s.opacity_lr, &s.scaling_lr, &s.rotation_lr}) *rate *= 10;
}

inline void draw_points(trial& t, std::size_t count) {
    t.scene.points = gs::synthetic_points("spheres", t.scene.train, count, t.seed);
}

/// Gives all views other cameras, their true photos, and the points that the training views see.
inline void replace_cameras(trial& t, const std::function<gs::camera(const gs::camera&, double)>& change) {
    for (auto* views : {&t.scene.train, &t.scene.test}) {
        for (std::size_t i = 0; i < views->size(); ++i) {
            gs::camera& c = (*views)[i].camera;
            c = change(c, static_cast<double>(i) / static_cast<double>(views->size() - 1));
        }
        gs::photograph_synthetic("spheres", *views);
    }
    draw_points(t, t.scene.points.size());
}

/// From pixels `first` at the first view to `last` at the last, geometrically.
inline void zoom(trial& t, double first, double last) {
    replace_cameras(t, [=](gs::camera c, double along) {
        c.fx = c.fy = first * std::pow(last / first, along);
        return c;
    });
}

/// On a circle among the spheres, just clear of them, with 90 degrees to see across.
inline void go_inside(trial& t) {
    replace_cameras(t, [](const gs::camera& c, double) {
        const double angle = std::atan2(c.center().y, c.center().x), across = angle + 2.4;
        return gs::look_at({0.55 * std::cos(angle), 0.55 * std::sin(angle), 0.32},
                           {0.6 * std::cos(across), 0.6 * std::sin(across), -0.2}, {0, 0, 1}, c.width,
                           0.5 * c.width);
    });
}

inline void displace(trial& t, double offset, double scale) {
    t.offset = {offset, -offset, offset};
    t.scale = scale;
    for (auto* views : {&t.scene.train, &t.scene.test})
        for (gs::view& v : *views)
            v.camera.translation = scale * (v.camera.translation - v.camera.rotation * t.offset);
    for (gs::colored_point& p : t.scene.points) p.position = scale * (p.position + t.offset);
}

inline const std::vector<hard_case>& hard_cases() {
    static const std::vector<hard_case> all{
        {"baseline", "nothing, to compare with", [](trial&) {}},
        {"rates", "all learning rates times 10", [](trial& t) { speed_up(t.schedule); }},
        {"resets", "opacity reset every 100 iterations",
         [](trial& t) { t.adaptive.opacity_reset_interval = 100; }},
        {"rates_and_resets", "both of these, to the last iteration",
         [](trial& t) {
             speed_up(t.schedule);
             t.adaptive.opacity_reset_interval = 100;
             t.adaptive.densify_until_iter = t.schedule.iterations.last();
         }},
        {"one_view", "one view, and the points that it sees",
         [](trial& t) {
             t.scene.train.resize(1);
             draw_points(t, t.scene.points.size());
         }},
        {"identical_views", "two identical views, and the points that they see",
         [](trial& t) {
             t.scene.train.resize(2);
             t.scene.train[1] = t.scene.train[0];
             draw_points(t, t.scene.points.size());
         }},
        {"one_gaussian", "a single Gaussian, and no room for more",
         [](trial& t) {
             t.scene.points.resize(1);
             t.cap = 1;
         }},
        {"from_one_gaussian", "a single Gaussian at first", [](trial& t) { t.scene.points.resize(1); }},
        {"many_gaussians", "millions of Gaussians, none ever dropped",
         [](trial& t) {
             draw_points(t, t.large_count);
             t.cap = t.large_count;
             t.schedule.iterations = t.large_iterations;
             t.adaptive.densify_until_iter = 0;
         }},
        {"inside", "all cameras inside the cloud", go_inside},
        {"focal_10", "a focal length of 10 pixels", [](trial& t) { zoom(t, 10, 10); }},
        {"focal_10000", "a focal length of 10,000 pixels", [](trial& t) { zoom(t, 10000, 10000); }},
        {"focal_10_to_10000", "focal lengths from 10 to 10,000 pixels in one scene",
         [](trial& t) { zoom(t, 10, 10000); }},
        {"offset", "coordinates offset by 10^4", [](trial& t) { displace(t, 1e4, 1); }},
        {"small", "coordinates scaled by 10^-4", [](trial& t) { displace(t, 0, 1e-4); }},
        {"large", "coordinates scaled by 10^4", [](trial& t) { displace(t, 0, 1e4); }},
        {"offset_small", "coordinates offset by 10^4, then scaled by 10^-4",
         [](trial& t) { displace(t, 1e4, 1e-4); }},
        {"offset_large", "coordinates offset by 10^4, then scaled by 10^4",
         [](trial& t) { displace(t, 1e4, 1e4); }},
    };
    return all;
}
