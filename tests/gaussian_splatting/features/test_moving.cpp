// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "../training/engines.hpp"
#include "device/cpu/cpu.hpp"
#include "evaluation/held_out_views.hpp"
#include "features/moving/moving_evidence.hpp"
#include "features/moving/moving_feature.hpp"
#include "features/moving/residual_weights.hpp"
#include "random_render.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using namespace gs::features;
using weights_type = residual_weights<gs::device::cpu>;

/// A gray photo, its render with small errors, and a gradient of ones.
struct compared_photo {
    static constexpr int width = 85, height = 66;  // the last cells are smaller
    static constexpr std::size_t pixels = std::size_t{width} * height;

    std::vector<std::uint8_t> rgba = std::vector<std::uint8_t>(4 * pixels, 128);
    std::vector<float> render = std::vector<float>(3 * pixels, 128 / 255.0f);
    std::vector<float> gradient = std::vector<float>(3 * pixels, 1.0f);

    explicit compared_photo(unsigned seed = 1) {
        std::mt19937 random(seed);
        for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
        for (float& x : render) x += 0.02f * (static_cast<float>(random() % 1000) / 999 - 0.5f);
    }
    /// Paints a rectangle white.
    void cover(int left, int top, int right, int bottom) {
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x)
                for (std::size_t c = 0; c < 3; ++c) rgba[4 * at(x, y) + c] = 255;
    }
    static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * width + x); }
    gs::train::target_image target(bool masked = false) const {
        return {rgba.data(), width, height, {}, masked};
    }
    void measure(weights_type& weights, const gs::row_range& own = {},
                 const gs::raster::list_capacity& capacity = {}) const {
        weights.measure(target(), render.data(), own, capacity);
    }
    /// Returns the weight of each pixel.
    std::vector<float> weigh(weights_type& weights) const {
        const float* weighted = weights.weigh(gradient.data());
        for (std::size_t i = 0; i < pixels; ++i)
            for (std::size_t c = 1; c < 3; ++c) REQUIRE(weighted[c * pixels + i] == weighted[i]);
        return {weighted, weighted + pixels};
    }
};

struct training_run {
    double psnr;
    std::vector<float> values;
    gs::gaussians model;
};

training_run trained(make_engine make, const gs::scene& scene, const std::vector<std::string>& effects,
                     int iterations, std::uint64_t seed = 0, gs::accumulator sums = gs::accumulator::native) {
    const auto e = make();
    gs::train::train_options o;
    o.schedule.iterations = iterations;
    o.schedule.sh_degree = 0;
    if (iterations < 500) o.schedule.num_downscales = 0;  // halved, small photos have too few cells
    o.max_cap = 10000;
    o.seed = seed;
    o.gradient = sums;
    std::vector<selected_feature> selected;
    for (const std::string& name : effects) selected.push_back({name, true, "", {}});
    o.features = feature_set(selected);
    e->set_views(scene.train, scene.test, o.schedule.num_downscales);
    e->set_model(gs::from_points(scene.points, 0, 3000, 1));
    gs::train::train(*e, scene, o, {[](const gs::train::progress&) {}, [](int) {}, [](int) {}});
    return {gs::evaluate::measure_held_out_views(*e, scene, {}, {}).psnr(), e->feature("moving").values(),
            e->get_model()};
}

moving_evidence evidence_in(const std::string& parameters) {
    gs::load_options o;
    o.data = "synthetic:" + parameters;
    const gs::scene scene = gs::load_scene(o, {});
    return find_moving_things(gs::scene_statistics(scene));
}

}  // namespace

TEST_CASE("moving: pixels of a thing that other photos lack get a small weight, and all others count fully") {
    gs::device::cpu device;
    weights_type weights(device);
    weights.reset(10);
    for (unsigned i = 0; i < 10; ++i) compared_photo(i).measure(weights);
    compared_photo covered;
    covered.cover(24, 16, 56, 40);
    covered.measure(weights);
    const std::vector<float> weight = covered.weigh(weights);
    for (int y = 0; y < covered.height; ++y)
        for (int x = 0; x < covered.width; ++x) {
            CAPTURE(x);
            CAPTURE(y);
            const float w = weight[covered.at(x, y)];
            const bool is_covered = x >= 24 && x < 56 && y >= 16 && y < 40;
            const bool is_near = x >= 16 && x < 64 && y >= 8 && y < 48;  // within a cell of it
            if (is_covered)
                CHECK(w == doctest::Approx(weigh_gradient::of_outlier));
            else if (!is_near)
                CHECK(w == 1);
        }
}

TEST_CASE("moving: single wrong pixels, as of fine details, count fully") {
    gs::device::cpu device;
    weights_type weights(device);
    weights.reset(10);
    for (unsigned i = 0; i < 10; ++i) compared_photo(i).measure(weights);
    compared_photo detailed;
    for (int y = 4; y < detailed.height; y += 16)
        for (int x = 4; x < detailed.width; x += 16) detailed.cover(x, y, x + 2, y + 2);
    detailed.measure(weights);
    CHECK(std::ranges::all_of(detailed.weigh(weights), [](float w) { return w == 1; }));
}

TEST_CASE("moving: at least half of a photo counts, even if a thing covers all of it") {
    gs::device::cpu device;
    weights_type weights(device);
    weights.reset(10);
    for (unsigned i = 0; i < 10; ++i) compared_photo(i).measure(weights);
    compared_photo covered;
    covered.cover(0, 0, covered.width, covered.height);
    covered.measure(weights);
    const std::vector<float> weight = covered.weigh(weights);
    CHECK(std::ranges::count(weight, 1.0f) >= static_cast<std::ptrdiff_t>(covered.pixels / 2));
}

TEST_CASE("moving: small residuals count fully, however alike all others are") {
    gs::device::cpu device;
    weights_type weights(device);
    weights.reset(10);
    compared_photo exact;
    std::ranges::fill(exact.render, 128 / 255.0f);
    for (int i = 0; i < 10; ++i) exact.measure(weights);
    CHECK(weights.limit() == update_limit::least);
    for (std::size_t i = 0; i < exact.pixels / 4; ++i) exact.render[i] += 0.1f;  // a third of it in the mean
    exact.measure(weights);
    CHECK(std::ranges::all_of(exact.weigh(weights), [](float w) { return w == 1; }));
}

TEST_CASE("moving: masked pixels do not count") {
    gs::device::cpu device;
    weights_type weights(device);
    weights.reset(2);
    compared_photo photo;
    photo.measure(weights);
    const float before = weights.limit();
    photo.cover(0, 0, photo.width, photo.height / 2);
    gs::image masked{photo.width, photo.height, photo.rgba};
    for (std::size_t i = 0; i < photo.pixels / 2; ++i) masked.mask_pixel(i);
    weights.measure({masked.rgba.data(), photo.width, photo.height, {}, true}, photo.render.data(), {}, {});
    CHECK(weights.limit() == before);
}

TEST_CASE(
    "moving: an incomplete render changes no statistics, and a value that is not finite does not count") {
    gs::device::cpu device;
    weights_type weights(device), other(device);
    weights.reset(4);
    other.reset(4);
    compared_photo photo;
    photo.measure(weights);
    photo.measure(other);
    compared_photo wrong;
    wrong.cover(0, 0, wrong.width, wrong.height);
    const std::uint64_t required = 2;
    wrong.measure(weights, {}, {&required, 1});
    CHECK(weights.limit() == other.limit());
    photo.render[7] = std::numeric_limits<float>::quiet_NaN();
    photo.measure(weights);
    compared_photo().measure(other);
    CHECK(std::abs(weights.limit() - other.limit()) < 1e-3f);
    CHECK(std::ranges::all_of(photo.weigh(weights), [](float w) { return w == 1; }));
}

TEST_CASE("moving: a checkpoint keeps the residuals of earlier views") {
    gs::device::cpu device;
    weights_type first(device), second(device);
    first.reset(10);
    second.reset(10);
    compared_photo rough;
    for (std::size_t i = 0; i < rough.render.size(); ++i) rough.render[i] += 0.05f;
    for (int i = 0; i < 5; ++i) rough.measure(first);
    gs::state_archive saved;
    first.exchange(saved);
    gs::state_archive loaded(saved.values(), saved.arrays()), empty({}, {});
    second.exchange(empty);
    second.exchange(loaded);
    const compared_photo photo;
    photo.measure(first);
    photo.measure(second);
    CHECK(second.limit() == first.limit());
    CHECK(second.limit() > 0.1f);
}

TEST_CASE("moving: the effect changes a training on moving things, with equal bits each time") {
    const gs::scene scene = small_scene("synthetic:spheres,moving=1", 64);
    for (const auto make : engines()) {
        const auto off = trained(make, scene, {}, 100, 0, gs::accumulator::fixed),
                   on = trained(make, scene, {"moving"}, 100, 0, gs::accumulator::fixed),
                   again = trained(make, scene, {"moving"}, 100, 0, gs::accumulator::fixed);
        CHECK(off.values.empty());
        REQUIRE(on.values.size() == 1);
        CHECK(on.values[0] >= update_limit::least);
        CHECK(on.model.mean == again.model.mean);
        CHECK(on.model.mean != off.model.mean);
    }
}

TEST_CASE("moving: detection finds the photos with moving things") {
    const moving_evidence found = evidence_in("spheres,moving=0.2,noise=0.02");
    CHECK(found.points > 1000);
    CHECK(found.is_clear());
    CHECK(found.count() >= 4);
    CHECK(found.count() <= 10);  // of 48 photos
    CHECK_FALSE(evidence_in("spheres,gloss=1").is_clear());
    CHECK(moving_feature().analyze(gs::scene_statistics(gs::scene{})).recommended == std::nullopt);
}

TEST_CASE("long: moving: detection finds nothing in static scenes") {
    for (const char* scene :
         {"spheres", "spheres,exposure=0.4,noise=0.03", "alpha,scales=4", "spheres,poses=1"}) {
        CAPTURE(std::string(scene));
        CHECK_FALSE(evidence_in(scene).is_clear());
    }
}

TEST_CASE("long: moving: a training recovers the scene, and loses nothing without moving things") {
    const gs::scene clean = small_scene("synthetic:spheres", 128),
                    moving = small_scene("synthetic:spheres,moving=1", 128);
    gs::scene masked = moving;
    for (std::size_t v = 0; v < masked.train.size(); ++v) {
        gs::image& photo = masked.train[v].pixels;
        for (std::size_t i = 0; i < photo.rgba.size() / 4; ++i)
            if (!std::equal(&photo.rgba[4 * i], &photo.rgba[4 * i] + 4, &clean.train[v].pixels.rgba[4 * i])) {
                photo.mask_pixel(i);
                photo.has_mask = true;
            }
    }
    for (const auto make : engines()) {
        std::array<double, 5> mean{};
        for (const std::uint64_t seed : {0, 1, 2}) {
            const auto psnr = [&](const gs::scene& scene, const std::vector<std::string>& effects) {
                return trained(make, scene, effects, 1500, seed).psnr / 3;
            };
            mean[0] += psnr(clean, {});
            mean[1] += psnr(clean, {"moving"});
            mean[2] += psnr(masked, {});
            mean[3] += psnr(moving, {});
            mean[4] += psnr(moving, {"moving"});
        }
        CAPTURE(mean);
        CHECK(mean[1] > mean[0] - 0.1);
        CHECK(mean[4] > mean[2] - 0.1);
        CHECK(mean[4] > mean[3] + 0.3);
    }
}
