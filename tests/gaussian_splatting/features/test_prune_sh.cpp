// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "../training/engines.hpp"
#include "device/cpu/cpu.hpp"
#include "engine/sh_degree_state.hpp"
#include "features/sh_degree/prune_sh.hpp"
#include "training/initialize.hpp"

namespace {

using gs::gaussians;
using gs::train::engine;

/// Colors with SH bands of every degree, larger for each Gaussian than for the one before.
gaussians model_with_sh(const gs::scene& scene, std::size_t count) {
    gaussians model = gs::from_points(scene.points, 3, count, 1);
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const auto rest = static_cast<std::size_t>(model.rest_width());
    for (std::size_t i = 0; i < model.sh_rest.size(); ++i)
        model.sh_rest[i] =
            0.2f * static_cast<float>(i / rest + 1) / static_cast<float>(count) * normal(random);
    for (float& o : model.opacity) o = normal(random);
    return model;
}

std::unique_ptr<engine> engine_with(make_engine make, const gs::scene& scene, const gaussians& model) {
    auto e = make();
    e->set_views(scene.train, {});
    e->set_model(model);
    gs::train::training_setup setup;
    setup.facts.gradient = gs::accumulator::fixed;
    e->begin(setup);
    e->reserve();
    return e;
}

/// Root mean square of the difference between what two engines render of the training views.
double difference(engine& a, engine& b, const gs::scene& scene) {
    double sum = 0, values = 0;
    for (const gs::view& v : scene.train) {
        const auto x = a.render(v.camera, {}), y = b.render(v.camera, {});
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double d = static_cast<double>(x[i]) - static_cast<double>(y[i]);
            sum += d * d;
        }
        values += static_cast<double>(x.size());
    }
    return std::sqrt(sum / values);
}

/// Where each Gaussian of `now` was in `before`, by its mean, which no other has.
std::vector<std::size_t> origins(const gaussians& now, const gaussians& before) {
    const auto mean = [](const gaussians& g, std::size_t i) {
        return std::array{g.mean[3 * i], g.mean[3 * i + 1], g.mean[3 * i + 2]};
    };
    std::map<std::array<float, 3>, std::size_t> places;
    for (std::size_t i = 0; i < before.count(); ++i) places[mean(before, i)] = i;
    CHECK(places.size() == before.count());
    std::vector<std::size_t> from;
    for (std::size_t i = 0; i < now.count(); ++i) from.push_back(places.at(mean(now, i)));
    return from;
}

/// Counts the rows among the first `rows` that differ from `before`.
std::size_t changed(const std::vector<float>& now, const std::vector<float>& before,
                    const std::vector<std::size_t>& from, std::size_t rows) {
    const std::size_t width = now.size() / from.size();
    std::size_t n = 0;
    for (std::size_t i = 0; i < rows; ++i)
        n += !std::equal(now.begin() + static_cast<std::ptrdiff_t>(i * width),
                         now.begin() + static_cast<std::ptrdiff_t>((i + 1) * width),
                         before.begin() + static_cast<std::ptrdiff_t>(from[i] * width));
    return n;
}

/// A model in which every second Gaussian has the same color in all directions.
gaussians half_with_sh(const gs::scene& scene, std::size_t count) {
    gaussians model = model_with_sh(scene, count);
    const auto rest = static_cast<std::size_t>(model.rest_width());
    for (std::size_t i = 0; i < count; i += 2) {
        std::fill_n(model.sh_rest.begin() + static_cast<std::ptrdiff_t>(i * rest), rest, 0.0f);
        std::fill_n(model.sh_constant.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, 0.0f);
    }
    return model;
}

/// A single Gaussian that fills all pixels.
gaussians one_before_all(const gs::scene& scene) {
    gaussians one = model_with_sh(scene, 1);
    one.mean = {0, 0, 0};
    one.log_scale = {1, 1, 1};
    one.opacity = {10};
    return one;
}

}  // namespace

TEST_CASE("prune_sh: changes views by the permitted amount at most, and uses it") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const gaussians model = model_with_sh(scene, 1000);
        const auto whole = engine_with(make, scene, model);
        std::size_t last = 1001;
        for (const double change : {1e-4, 3e-3, 1e-2, 1.0}) {
            CAPTURE(change);
            const auto e = engine_with(make, scene, model);
            const std::size_t with_sh = sh_of(*e).prune(change);
            CHECK(with_sh < last);
            CHECK((with_sh == 1000 || with_sh % gs::block_length == 0));
            const double differs = difference(*e, *whole, scene);
            CHECK(differs <= change);
            if (change == 1e-4)
                CHECK(with_sh == 1000);  // less than a tenth
            else
                CHECK(differs > 0.15 * std::min(change, 0.05));
            last = with_sh;
        }
        CHECK(last == 0);

        // With a single Gaussian the estimate is exact.
        const gaussians one = one_before_all(scene);
        const auto e = engine_with(make, scene, one), before = engine_with(make, scene, one);
        CHECK(sh_of(*e).prune(1) == 0);
        const double differs = difference(*e, *before, scene);
        CHECK(differs > 0.01);
        CHECK(sh_of(*engine_with(make, scene, one)).prune(0.98 * differs) == 1);
        CHECK(sh_of(*engine_with(make, scene, one)).prune(1.05 * differs) == 0);
    }
}

TEST_CASE("prune_sh: a pruned Gaussian has its mean color over the training views") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const gaussians one = one_before_all(scene);
        const auto e = engine_with(make, scene, one), before = engine_with(make, scene, one);
        CHECK(sh_of(*e).prune(1) == 0);
        for (std::size_t c = 0; c < 3; ++c) {
            double sum[2] = {};
            for (const gs::view& v : scene.train) {
                const auto x = before->render(v.camera, {}), y = e->render(v.camera, {});
                for (std::size_t i = x.size() / 3 * c; i < x.size() / 3 * (c + 1); ++i) {
                    sum[0] += static_cast<double>(x[i]);
                    sum[1] += static_cast<double>(y[i]);
                }
            }
            CHECK(sum[1] == doctest::Approx(sum[0]).epsilon(1e-4));
        }
    }
}

TEST_CASE("prune_sh: moves pruned Gaussians to the end and keeps everything else") {
    const gs::scene scene = small_scene();
    for (const auto make : engines()) {
        const gaussians model = model_with_sh(scene, 1000);
        const auto e = engine_with(make, scene, model);
        const std::size_t with_sh = sh_of(*e).prune(0.01);
        REQUIRE(with_sh > 0);
        REQUIRE(with_sh < 900);
        const gaussians now = e->get_model();
        const auto from = origins(now, model);
        CHECK(changed(now.log_scale, model.log_scale, from, 1000) == 0);
        CHECK(changed(now.quaternion, model.quaternion, from, 1000) == 0);
        CHECK(changed(now.opacity, model.opacity, from, 1000) == 0);
        CHECK(changed(now.sh_constant, model.sh_constant, from, with_sh) == 0);
        CHECK(changed(now.sh_rest, model.sh_rest, from, with_sh) == 0);
        const auto middle = from.begin() + static_cast<std::ptrdiff_t>(with_sh);
        CHECK(std::is_sorted(from.begin(), middle));
        CHECK(std::is_sorted(middle, from.end()));
        CHECK(std::all_of(now.sh_rest.begin() + now.rest_width() * static_cast<std::ptrdiff_t>(with_sh),
                          now.sh_rest.end(), [](float x) { return x == 0; }));

        // Renders the same after a round trip, and later densification restores the coefficients as zeros.
        const auto other = engine_with(make, scene, now);
        CHECK(difference(*e, *other, scene) == 0);
        sh_of(*e).set_degree(1);
        CHECK(difference(*e, *other, scene) > 0);
        sh_of(*e).set_degree(3);
        auto still = plan_for(0);
        still.rates = {};
        e->step(still);
        prune_once(*e, 0.2);
        const gaussians fewer = e->get_model();
        REQUIRE(fewer.count() == 800);
        const auto first = origins(fewer, now);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < 800; ++i)
            for (std::size_t k = 0; k < 45; ++k)
                wrong += fewer.sh_rest[45 * i + k] != (k < 9 ? now.sh_rest[45 * first[i] + k] : 0.0f);
        CHECK(wrong == 0);
        still.sh_degree = 3;
        still.rates.fill(1e-3f);
        e->step(still);
        const gaussians learnt = e->get_model();
        CHECK(std::any_of(learnt.sh_rest.begin() + 45 * static_cast<std::ptrdiff_t>(with_sh),
                          learnt.sh_rest.end(), [](float x) { return x != 0; }));
    }
}

TEST_CASE("prune_sh: training continues as if the pruned coefficients were zero and not learned") {
    const gs::scene scene = small_scene();
    for (const auto make : engines())
        for (const bool updates_sh : {true, false}) {
            CAPTURE(updates_sh);
            const gaussians model = half_with_sh(scene, 1000);
            const auto whole = engine_with(make, scene, model), e = engine_with(make, scene, model);
            auto plan = plan_for(0);
            plan.sh_degree = 3;
            const auto rates = plan.rates;
            // All get momentum, but colors stay: zeros remain exact.
            std::fill(plan.rates.begin() + 4, plan.rates.end(), 0.0f);
            for (; plan.view < 6; ++plan.view) {
                whole->step(plan);
                e->step(plan);
            }
            const gaussians before = whole->get_model();
            const std::size_t with_sh = sh_of(*e).prune(0);
            CHECK(with_sh >= 500 - gs::block_length);
            REQUIRE(with_sh < 500 + gs::block_length);
            const auto from = origins(e->get_model(), before);
            plan.rates = rates;
            plan.updates_sh = updates_sh;
            for (; plan.view < (updates_sh ? 7 : 9); ++plan.view) {  // otherwise zeros would learn
                whole->step(plan);
                e->step(plan);
            }
            const gaussians a = e->get_model(), b = whole->get_model();
            CHECK(changed(a.mean, before.mean, from, 1000) > 500);
            CHECK(changed(a.mean, b.mean, from, 1000) == 0);
            CHECK(changed(a.log_scale, b.log_scale, from, 1000) == 0);
            CHECK(changed(a.quaternion, b.quaternion, from, 1000) == 0);
            CHECK(changed(a.opacity, b.opacity, from, 1000) == 0);
            CHECK(changed(a.sh_constant, b.sh_constant, from, 1000) == 0);
            CHECK(changed(a.sh_rest, b.sh_rest, from, with_sh) == 0);
            CHECK((changed(a.sh_rest, before.sh_rest, from, with_sh) > with_sh / 2) == updates_sh);
            CHECK(changed(a.sh_rest, before.sh_rest, from, 1000) ==
                  changed(a.sh_rest, before.sh_rest, from, with_sh));
        }
}

TEST_CASE("prune_sh: frees the memory of the smallest errors, in values and moments") {
    using device = gs::device::cpu;
    device d;
    constexpr std::size_t count = 1000;
    gs::train::trained_parameters<device> of;
    for (auto* all : {&of.values, &of.first, &of.second}) {
        all->resize(count, 3);
        all->zero(d);
    }
    of.last_step.resize(count);
    std::vector<gs::train::sh_error> errors(count);
    for (std::size_t i = 0; i < count; ++i) {
        of.values[3].data()[i] = static_cast<float>(i);  // the opacity: who it is
        of.last_step.data()[i] = static_cast<std::uint32_t>(i);
        errors[i] = {1, {0.5f, 0.5f, 0.5f}, static_cast<float>((7 * i) % count)};
    }
    const gs::gaussian_shares shares;
    gs::train::parameter_gather<device> gather(d, shares);
    gs::train::sh_pruner<device> pruner(d, gather);
    pruner.prune(of, count, 3, errors.data(), 97 * 96 / 2);  // 97 Gaussians: errors 0 to 96
    CHECK(of.values.gaussians_with_sh() == count);
    pruner.prune(of, count, 3, errors.data(), 500 * 499 / 2);
    CHECK(of.values.gaussians_with_sh() == 512);
    for (auto* all : {&of.values, &of.first, &of.second}) {
        std::size_t floats = 0;
        for (std::size_t p = 0; p < gs::parameter_count; ++p) floats += (*all)[p].size();
        CHECK(floats == 14 * gs::in_whole_blocks(count) + 45 * 512);
    }
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t who = of.last_step.data()[i];
        wrong += of.values[3].data()[i] != static_cast<float>(who);
        wrong += (errors[who].squares < static_cast<float>(count - 512)) != (i >= 512);
    }
    CHECK(wrong == 0);
}
