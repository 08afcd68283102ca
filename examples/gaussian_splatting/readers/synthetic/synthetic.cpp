// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "synthetic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "../../core/error.hpp"
#include "../../core/parallel.hpp"
#include "../../image/mask.hpp"
#include "../size_text.hpp"
#include "synthetic_cameras.hpp"
#include "synthetic_parameters.hpp"
#include "synthetic_passers.hpp"
#include "synthetic_random.hpp"
#include "synthetic_response.hpp"
#include "synthetic_vignetting.hpp"
#include "synthetic_walls.hpp"

namespace gs {
namespace {

constexpr int largest_size = 2048;  // 48 images of this size take 0.8 GB
constexpr int views_per_test_view = 6;
constexpr int samples_per_side = 4;
constexpr double nearest_hit = 1e-6;

using vec = glm::dvec3;

enum class pattern { bands, checks };

/// Two colors in linear light, which alternate smoothly along `wave`, in radians per unit of
/// length.
struct albedo {
    vec first;
    vec second;
    pattern kind = pattern::bands;
    vec wave{0};
};

struct ball {
    vec center;
    double radius;
    albedo paint;
};

struct ground_disc {
    double height;
    double radius;
    albedo paint;
};

struct world {
    std::vector<ball> balls;
    std::optional<ground_disc> ground;
    bool transparent = false;  ///< whether the background is transparent; otherwise it is black
    synthetic_parameters how;
};

struct surface_point {
    vec position;
    vec normal;
    vec albedo;
};

// Positions are chosen by eye. The checks of the ground span several pixels at the native size.
world spheres_world() {
    const double floor = -0.32;
    const auto standing = [floor](double x, double y, double radius, albedo paint) {
        return ball{{x, y, floor + radius}, radius, paint};
    };
    world w;
    w.balls = {
        standing(0.00, 0.05, 0.46, {{0.86, 0.22, 0.14}, {0.95, 0.66, 0.42}, pattern::bands, {3, 5, 15}}),
        standing(0.70, 0.20, 0.27, {{0.05, 0.36, 0.48}, {0.25, 0.72, 0.70}, pattern::checks, {13, 13, 13}}),
        standing(-0.66, 0.34, 0.31, {{0.93, 0.62, 0.08}, {0.98, 0.84, 0.40}, pattern::bands, {17, -9, 0}}),
        standing(-0.48, -0.52, 0.24, {{0.36, 0.16, 0.58}, {0.74, 0.50, 0.86}, pattern::bands, {0, 12, -18}}),
        standing(0.32, -0.62, 0.19, {{0.12, 0.46, 0.16}, {0.62, 0.82, 0.28}, pattern::checks, {17, 17, 17}}),
        standing(0.28, 0.74, 0.22, {{0.90, 0.88, 0.84}, {0.30, 0.46, 0.80}, pattern::bands, {-14, 10, 16}}),
        standing(-0.93, -0.16, 0.13, {{0.84, 0.10, 0.30}, {0.95, 0.45, 0.55}, pattern::checks, {20, 20, 20}}),
        standing(0.78, -0.36, 0.12, {{0.95, 0.93, 0.88}, {0.95, 0.80, 0.60}, pattern::bands, {0, 0, 24}}),
    };
    w.ground = {floor, 1.3, {{0.10, 0.15, 0.27}, {0.66, 0.62, 0.56}, pattern::checks, {9.5, 9.5, 0}}};
    return w;
}

world alpha_world() {
    world w;
    w.balls = {{{0, 0, 0}, 0.55, {{0.06, 0.26, 0.50}, {0.92, 0.70, 0.38}, pattern::bands, {4, -3, 14}}}};
    const vec colors[] = {{0.90, 0.26, 0.14}, {0.95, 0.65, 0.10}, {0.30, 0.66, 0.22},
                          {0.08, 0.55, 0.60}, {0.45, 0.22, 0.72}, {0.88, 0.25, 0.50}};
    for (int i = 0; i < 6; ++i) {
        const double angle = i * std::numbers::pi / 3;
        const double radius = 0.15 + 0.03 * (i % 3);
        const vec center{0.95 * std::cos(angle), 0.95 * std::sin(angle), 0.3 * std::sin(2 * angle)};
        const vec& color = colors[i];
        const pattern kind = i % 2 == 0 ? pattern::checks : pattern::bands;
        w.balls.push_back({center, radius, {color, 0.5 * color + 0.45, kind, {14, 14, 14}}});
    }
    w.transparent = true;
    return w;
}

struct named_world {
    const char* name;
    world (*make)();
};
constexpr named_world worlds[] = {{"spheres", spheres_world}, {"alpha", alpha_world}};

world world_of(const std::string& text) {
    const synthetic_parameters how = parse_synthetic(text);
    std::string known;
    for (const named_world& candidate : worlds) {
        if (how.world == candidate.name) {
            world made = candidate.make();
            made.how = how;
            const char* lacked = how.sky > 0          ? "sky"
                                 : how.walls > 0      ? "walls"
                                 : how.vignetting > 0 ? "vignetting"
                                 : how.response > 0   ? "response"
                                                      : nullptr;
            if (lacked != nullptr && made.transparent)
                throw error("the synthetic scene '" + how.world +
                            "' is transparent where it has nothing: it has no " + lacked);
            return made;
        }
        known += (known.empty() ? "" : ", ") + std::string(candidate.name);
    }
    throw error("there is no synthetic scene '" + how.world + "'; there are: " + known);
}

/// Returns a square wave with rounded flanks. It looks like clear stripes, but no edge is finer
/// than a pixel.
double rounded_square_wave(double sine) { return sine / std::sqrt(sine * sine + 0.15) * std::sqrt(1.15); }

vec color_at(const albedo& paint, const vec& p) {
    double wave = 0;
    if (paint.kind == pattern::bands) {
        wave = std::sin(glm::dot(paint.wave, p));
    } else {
        wave = std::cos(paint.wave.x * p.x) * std::cos(paint.wave.y * p.y) * std::cos(paint.wave.z * p.z);
    }
    return glm::mix(paint.first, paint.second, 0.5 + 0.5 * rounded_square_wave(wave));
}

/// Returns the distance along the ray to its entry into the ball. Preconditions: `direction` has
/// length one, and the ray starts outside.
double distance_to(const ball& b, const vec& origin, const vec& direction) {
    const vec to_origin = origin - b.center;
    const double along = glm::dot(to_origin, direction);
    const double discriminant = along * along - glm::dot(to_origin, to_origin) + b.radius * b.radius;
    if (discriminant < 0) return std::numeric_limits<double>::infinity();
    const double distance = -along - std::sqrt(discriminant);
    return distance > nearest_hit ? distance : std::numeric_limits<double>::infinity();
}

double distance_to(const ground_disc& g, const vec& origin, const vec& direction) {
    const double distance = (g.height - origin.z) / direction.z;
    const vec p = origin + distance * direction;
    const bool hit = distance > nearest_hit && p.x * p.x + p.y * p.y < g.radius * g.radius;
    return hit ? distance : std::numeric_limits<double>::infinity();
}

std::optional<surface_point> first_hit(const world& w, const vec& origin, const vec& direction) {
    double nearest = std::numeric_limits<double>::infinity();
    const ball* hit = nullptr;
    for (const ball& b : w.balls) {
        const double distance = distance_to(b, origin, direction);
        if (distance < nearest) {
            nearest = distance;
            hit = &b;
        }
    }
    if (w.ground && distance_to(*w.ground, origin, direction) < nearest) {
        const vec p = origin + distance_to(*w.ground, origin, direction) * direction;
        return surface_point{p, {0, 0, 1}, color_at(w.ground->paint, p)};
    }
    if (hit == nullptr) return std::nullopt;
    const vec p = origin + nearest * direction;
    return surface_point{p, (p - hit->center) / hit->radius, color_at(hit->paint, p - hit->center)};
}

/// Returns the visible share, 0 to 1, of a round sun with the angular radius `sun_softness` behind
/// one ball. Points of the ball itself need no special case: the ball lies behind them, or they
/// face away from the sun.
double sun_past(const ball& b, const vec& position, const vec& sun) {
    constexpr double sun_softness = 0.12;
    const vec to_center = b.center - position;
    const double along = glm::dot(to_center, sun);
    if (along <= 0) return 1;
    const double softness = sun_softness * along, outer = b.radius + softness;
    const vec miss = to_center - along * sun;
    if (glm::dot(miss, miss) > 1.001 * outer * outer) return 1;  // most often, and without a root
    return glm::smoothstep(b.radius - softness, outer, glm::length(miss));
}

/// Returns the visible share of the sky: one minus the ball's solid angle, weighted by the cosine.
double sky_past(const ball& b, const surface_point& s) {
    const vec to_center = b.center - s.position;
    const double above = glm::dot(s.normal, to_center);
    if (above <= 0) return 1;
    const double distance = glm::length(to_center);
    return 1 - above / distance * b.radius * b.radius / (distance * distance);
}

/// Returns the brightness of the light, which fades inside the rim of the ground to hide the rim.
double pool_of_light(const world& w, const vec& p) {
    if (!w.ground) return 1;
    return 1 - glm::smoothstep(0.5 * w.ground->radius, 0.98 * w.ground->radius, std::hypot(p.x, p.y));
}

vec to_sun() { return glm::normalize(vec{0.50, -0.42, 0.80}); }

/// Returns the color of the sky in a direction: bluer upward, and brighter around the sun.
vec sky(const world& w, const vec& direction) {
    const vec low{0.55, 0.50, 0.45}, high{0.30, 0.50, 0.85}, glow{0.25, 0.22, 0.17};
    const double near_sun = std::pow(std::max(glm::dot(direction, to_sun()), 0.0), 4);
    return w.how.sky * (glm::mix(low, high, 0.5 + 0.5 * direction.z) + near_sun * glow);
}

/// Returns the color behind all surfaces.
vec color_behind(const world& w, const vec& origin, const vec& direction) {
    return w.how.walls > 0 ? wall_color(w.how, place_on_walls(w.how, origin, direction)) : sky(w, direction);
}

/// Returns the color of a surface under a warm sun and a cool sky, as displayed, in [0, 1]. Glossy
/// surfaces also show the sun as a Phong lobe and the sky in the mirrored direction, more strongly
/// at grazing angles (Schlick's formula). Precondition: `to_eye` has length one.
vec shade(const world& w, const surface_point& s, const vec& to_eye) {
    static const vec sun_direction = to_sun();
    const vec sun_color{0.90, 0.83, 0.71};
    const vec sky_color{0.25, 0.31, 0.40};
    const vec bounce_color{0.13, 0.11, 0.10};

    double sun = std::max(glm::dot(s.normal, sun_direction), 0.0);
    double sky = 1;
    for (const ball& b : w.balls) {
        if (sun > 0) sun *= sun_past(b, s.position, sun_direction);
        sky *= sky_past(b, s);
    }
    const vec ambient = glm::mix(bounce_color, sky_color, 0.5 + 0.5 * s.normal.z);
    const double pool = pool_of_light(w, s.position);
    vec color = pool * (sun * sun_color + sky * ambient) * s.albedo;
    if (w.how.gloss > 0) {
        const double facing = std::max(glm::dot(s.normal, to_eye), 0.0);
        const vec mirrored = 2 * facing * s.normal - to_eye;
        constexpr double sharpness = 16, head_on = 0.25;
        const double lobe =
            sun > 0 ? std::pow(std::max(glm::dot(mirrored, sun_direction), 0.0), sharpness) : 0;
        const double share = w.how.gloss * (head_on + (1 - head_on) * std::pow(1 - facing, 5));
        color += pool * share *
                 (2 * lobe * sun_color + glm::mix(bounce_color, 2.0 * sky_color, 0.5 + 0.5 * mirrored.z));
    }
    return glm::sqrt(glm::clamp(color, 0.0, 1.0));
}

/// Returns the exposure of a photo, a factor on displayed values.
double exposure_of(const world& w, std::size_t photo) {
    std::mt19937_64 random(~photo);  // distinct from the seeds of the noise
    return std::exp2(w.how.exposure * normal(random));
}

/// Returns the cameras of a row, one after another in time: a single one, or several of a camera that
/// moves.
std::vector<camera> cameras_of_row(const camera& c, int row) {
    if (!c.motion) return {c};
    constexpr int times = 32;
    std::vector<camera> cameras;
    const double read = c.motion->readout * ((row + 0.5) / c.height - 0.5);
    for (int i = 0; i < times; ++i)
        cameras.push_back(at_time(c, read + c.motion->exposure * ((i + 0.5) / times - 0.5)));
    return cameras;
}

void render_row(const world& w, const camera& c, std::size_t photo, int row, std::uint8_t* rgba) {
    const std::vector<camera> cameras = cameras_of_row(c, row);
    const int samples = std::max(samples_per_side * samples_per_side, static_cast<int>(cameras.size()));
    const double weight = 1.0 / samples;
    const double exposure = w.how.exposure > 0 ? exposure_of(w, photo) : 1;
    std::mt19937_64 random((photo << 32) + static_cast<std::size_t>(row));
    for (int column = 0; column < c.width; ++column, rgba += 4) {
        vec color{0};
        int hits = 0;
        for (int sample = 0; sample < samples; ++sample) {
            // Places in the pixel and times are combined so that neither determines the other.
            const camera& c_now = cameras[static_cast<std::size_t>(sample * 11) % cameras.size()];
            const double x = column + (sample % samples_per_side + 0.5) / samples_per_side;
            const double y = row + (sample / samples_per_side % samples_per_side + 0.5) / samples_per_side;
            const vec origin = c_now.center(), direction = c_now.ray(x, y);
            const std::optional<surface_point> hit = first_hit(w, origin, direction);
            if (!hit && w.how.sky == 0 && w.how.walls == 0) continue;
            color += hit ? shade(w, *hit, -direction) : color_behind(w, origin, direction);
            ++hits;
        }
        rgba[3] = w.transparent ? to_byte(weight * hits) : std::uint8_t{255};
        std::array<double, 3> falloff{1, 1, 1};
        if (w.how.vignetting > 0) falloff = synthetic_falloff(w.how, c, column + 0.5, row + 0.5);
        for (int channel = 0; channel < 3; ++channel) {
            double shown = exposure * falloff[static_cast<std::size_t>(channel)] * weight * color[channel];
            if (w.how.response > 0) shown = synthetic_response(w.how, shown);
            if (w.how.noise > 0 && hits > 0) shown += w.how.noise * normal(random);
            const double most = rgba[3] / 255.0;  // colors are premultiplied
            rgba[channel] = to_byte(std::clamp(shown, 0.0, most));
        }
    }
}

/// Returns inverse depths as a network might estimate them: with noise, and with an unknown scale
/// and offset. The background is infinitely far away.
depth_map estimated_depths(const world& w, const camera& c, std::size_t photo) {
    std::mt19937_64 random(photo + (std::uint64_t{1} << 62));
    const double offset = 0.1 + 0.2 * uniform(random), scale = 0.3 + 0.3 * uniform(random);
    std::vector<double> inverse;
    for (int row = 0; row < c.height; ++row)
        for (int column = 0; column < c.width; ++column) {
            const vec origin = c.center(), direction = c.ray(column + 0.5, row + 0.5);
            std::optional<vec> place;
            if (const std::optional<surface_point> hit = first_hit(w, origin, direction))
                place = hit->position;
            if (!place && w.how.walls > 0) place = place_on_walls(w.how, origin, direction);
            const auto seen = place ? c.see(*place) : std::nullopt;
            inverse.push_back(seen ? 1 / seen->depth : 0);
        }
    const double nearest = *std::ranges::max_element(inverse);
    depth_map map{c.width, c.height, {}};
    for (const double x : inverse) {
        const double seen = nearest > 0 ? x / nearest * (1 + w.how.depths * normal(random)) : 0;
        map.values.push_back(static_cast<std::uint16_t>(
            std::lround(std::clamp(65535 * (offset + scale * seen), 1.0, 65535.0))));
    }
    return map;
}

/// Takes some photos. The index of a photo determines its exposure, its noise and who passes by.
void take_photos(const world& w, std::vector<view>& views, const std::vector<std::size_t>& which,
                 bool masks = true) {
    struct place {
        std::size_t photo;
        int row;
    };
    std::vector<place> rows;
    for (const std::size_t i : which) {
        const int width = views[i].camera.width, height = views[i].camera.height;
        views[i].pixels = {width, height, {}, w.transparent, false};
        views[i].pixels.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        for (int row = 0; row < height; ++row) rows.push_back({i, row});
    }
#pragma omp parallel for schedule(dynamic, 8)
    for (const auto& [photo, row] : rows) {
        view& v = views[photo];
        const std::size_t bytes_per_row = 4 * static_cast<std::size_t>(v.camera.width);
        render_row(w, v.camera, photo, row,
                   v.pixels.rgba.data() + bytes_per_row * static_cast<std::size_t>(row));
    }
    if (w.how.passers > 0)
        for (const std::size_t i : which) paint_passer(w.how, i, masks, views[i].pixels);
}

/// Returns `count` of the values, evenly spread.
std::vector<std::size_t> spread(const std::vector<std::size_t>& all, std::size_t count) {
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < all.size(); ++i)
        if ((i + 1) * count / all.size() > i * count / all.size()) some.push_back(all[i]);
    return some;
}

std::vector<view> moved_out(std::vector<view>& views, const std::vector<std::size_t>& which) {
    std::vector<view> moved;
    for (const std::size_t i : which) moved.push_back(std::move(views[i]));
    return moved;
}

/// Returns points at which rays through random pixels of random views hit a surface. As in points
/// from structure from motion, each point is visible to a camera, and points are denser where more
/// cameras look.
std::vector<colored_point> seen_points(const world& w, const std::vector<view>& views, std::size_t count,
                                       std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<colored_point> points;
    while (points.size() < count) {
        const auto chosen = static_cast<std::size_t>(uniform(random) * static_cast<double>(views.size()));
        const camera& c = views[chosen].camera;
        const double x = uniform(random) * c.width;
        const double y = uniform(random) * c.height;
        const vec direction = c.ray(x, y);
        const std::optional<surface_point> hit = first_hit(w, c.center(), direction);
        if (!hit) continue;
        const vec color = shade(w, *hit, -direction);
        points.push_back({hit->position, {to_byte(color.r), to_byte(color.g), to_byte(color.b)}});
    }
    return points;
}

/// Returns the longer side of the photos.
int size_at(int resolution, const synthetic_parameters& how) {
    if (resolution > largest_size)
        throw error("a synthetic scene is drawn at up to " + std::to_string(largest_size) + " pixels, not " +
                    std::to_string(resolution));
    const int native = how.panorama > 0 ? 2 * synthetic_size : synthetic_size;
    return divides_size(resolution) ? native / resolution : resolution;
}

image_record record_of(view made, bool held_out) {
    image_record record;
    record.name = std::move(made.name);
    record.camera = made.camera;
    record.held_out = held_out;
    record.pixels = std::move(made.pixels);
    record.depth_pixels = std::move(made.depths);
    return record;
}

constexpr std::string_view prefix = "synthetic:";

scene_description describe(const load_options& options, const log_function& log) {
    const std::string name = options.data.substr(prefix.size());
    const world w = world_of(name);
    const int size = size_at(options.resolution, w.how);
    std::vector<view> views = synthetic_views(size, w.how);
    const auto is_held_out = [&](std::size_t i) {
        // The middle of each group, because the first and the last camera have fewer neighbors.
        return options.eval && i % views_per_test_view == views_per_test_view / 2;
    };
    std::vector<std::size_t> training, held_out;
    for (std::size_t i = 0; i < views.size(); ++i) (is_held_out(i) ? held_out : training).push_back(i);
    training = spread(training, std::min(training.size(), static_cast<std::size_t>(w.how.views)));
    std::vector<std::size_t> used = training;
    used.insert(used.end(), held_out.begin(), held_out.end());

    shake_cameras(views, w.how);
    for (const std::size_t i : held_out) views[i].camera.motion.reset();
    take_photos(w, views, used, options.masks);
    for (view& v : views) v.camera.motion.reset();
    if (w.how.depths >= 0 && options.depths)
        for_each_in_parallel(used.size(), [&](std::size_t k) {
            const std::size_t i = used[k];
            views[i].depths = estimated_depths(w, views[i].camera, i);
            clear_masked_depths(views[i].pixels, views[i].depths);
        });

    const camera first = views.front().camera;
    std::vector<view> train = moved_out(views, training), test = moved_out(views, held_out);

    for (std::size_t i = 0; i < train.size(); ++i) paint_moving_thing(w.how, i, train[i].pixels);

    scene_description result;
    result.object_centered = result.rendered = true;
    result.points = seen_points(w, train, static_cast<std::size_t>(w.how.points), options.seed);
    disturb_poses(train, 0, w.how);
    disturb_poses(test, train.size(), w.how);
    log("synthetic scene '" + name + "': " + std::to_string(train.size()) + " training and " +
        std::to_string(test.size()) + " test views of " + size_text(first.width, first.height) + ", " +
        std::to_string(result.points.size()) + " points");
    for (view& v : train) result.images.push_back(record_of(std::move(v), false));
    for (view& v : test) result.images.push_back(record_of(std::move(v), true));
    return result;
}

}  // namespace

constinit const reader synthetic_reader{"synthetic", "synthetic:NAME[,PARAMETER=VALUE...]",
                                        [](const std::string& data) { return data.starts_with(prefix); },
                                        describe};

std::vector<std::string> synthetic_scene_names() {
    std::vector<std::string> names;
    for (const named_world& w : worlds) names.emplace_back(w.name);
    return names;
}

void photograph_synthetic(const std::string& name, std::vector<view>& views) {
    std::vector<std::size_t> all(views.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    take_photos(world_of(name), views, all);
}

std::vector<colored_point> synthetic_points(const std::string& name, const std::vector<view>& views,
                                            std::size_t count, std::uint64_t seed) {
    return seen_points(world_of(name), views, count, seed);
}

}  // namespace gs
