// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../training/engine_with_parts.hpp"
#include "../training/engines.hpp"
#include "core/error.hpp"
#include "device/cpu/cpu.hpp"
#include "training/initialize.hpp"
#include "training/training.hpp"

namespace {

using cpu = gs::device::cpu;
using namespace gs::train;

constexpr int interval = 10, last_run = 30;
constexpr float penalty = 0.125f;

/// Subtracts a constant from all opacities, which are logits. One index for each Gaussian.
struct lower_all {
    float* opacity;
    gs::raster::list_capacity capacity;
    void operator()(std::size_t i) const {
        if (!capacity.exceeded()) opacity[i] -= penalty;
    }
};

/// The difference between render and target, at most 1, in one plane. One index for each pixel.
struct pixel_errors {
    gs::train::drawn_view drawn;
    std::size_t pixels;
    float* scores;
    void operator()(std::size_t p) const {
        float error = 0;
        for (std::size_t c = 0; c < 3; ++c)
            error += std::abs(drawn.render[c * pixels + p] -
                              static_cast<float>(drawn.target.rgba[4 * p + c]) / 255);
        scores[p] = std::min(error / 3, 1.0f);
        scores[pixels + p] = 1;
        scores[2 * pixels + p] = 0;
    }
};

/// A second strategy: lowers opacities in every step, and at its own interval adds a copy of the Gaussian in
/// whose pixels the training views show the largest error.
template <gs::device::device Device>
class copy_worst final : public strategy<Device> {
  public:
    copy_worst(const training_facts& facts, std::vector<std::string>& calls) : facts_(facts), calls_(calls) {}

    bool wants(int iteration) const override { return iteration <= last_run; }
    bool due(int iteration) const override { return iteration % interval == 0 && wants(iteration); }
    int count_is_final_after() const override { return last_run; }
    std::size_t memory_key(int iteration) const override { return iteration <= last_run ? 1 : 0; }

    void after_step(int iteration, const step_context<Device>& c) override {
        if (iteration > last_run) return;
        CHECK(c.rates[3] > 0);  // of opacities
        c.device.for_each_index(c.count, lower_all{c.parameters.values.write().opacity, c.capacity});
    }

    densify_report run(int iteration, const run_context<Device>& c) override {
        calls_.push_back("run " + std::to_string(iteration));
        CHECK(seen(c) > 0);
        CHECK(c.views.count() == static_cast<std::size_t>(facts_.views));
        const std::size_t worst = find_worst(c);
        c.gather.reserve(c.count + 1);
        for (std::size_t i = 0; i <= c.count; ++i) {
            c.gather.origins()[i] = static_cast<std::uint32_t>(i < c.count ? i : worst);
            c.gather.births()[i] = i == c.count ? birth::copy : birth::kept;
        }
        c.gather.run(c.parameters, c.count + 1, c.count + 1, c.sh_degree);
        return {c.count + 1};
    }

    void adjust(int iteration, const trained_gaussians<Device>& g) override {
        if (due(iteration)) calls_.push_back("adjust " + std::to_string(g.count));
    }

  private:
    /// In how many steps since the last run the Gaussians were drawn, all together.
    static float seen(const run_context<Device>& c) {
        float sum = 0;
        for (std::size_t i = 0; i < c.count; ++i) sum += c.statistics[i].seen;
        return sum;
    }

    static std::size_t find_worst(const run_context<Device>& c) {
        std::vector<float> errors(c.count), scores;
        for (std::size_t v = 0; v < c.views.count(); ++v) {
            const drawn_view drawn = c.views.draw(v);
            const auto pixels =
                static_cast<std::size_t>(drawn.target.width) * static_cast<std::size_t>(drawn.target.height);
            scores.resize(3 * pixels);
            c.device.for_each_index(pixels, pixel_errors{drawn, pixels, scores.data()});
            const float* sums = c.views.sum_scores(scores.data());
            for (std::size_t i = 0; i < c.count; ++i) {
                if (drawn.tiles[i] == 0) continue;
                const float* row = sums + i * gs::raster::record_stride;
                CHECK(row[gs::raster::sum_red] <= row[gs::raster::sum_green] * 1.001f + 1e-6f);
                CHECK(row[gs::raster::sum_blue] == 0);
                errors[i] += row[gs::raster::sum_red];
            }
        }
        const auto worst = std::ranges::max_element(errors);
        CHECK(*worst > 0);
        return static_cast<std::size_t>(worst - errors.begin());
    }

    training_facts facts_;
    std::vector<std::string>& calls_;
};

std::vector<std::string> calls;

std::unique_ptr<strategy<cpu>> make_copy_worst(cpu&, const strategy_settings&, const training_facts& facts) {
    return std::make_unique<copy_worst<cpu>>(facts, calls);
}

/// Asks for statistics that do not exist.
class demanding final : public strategy<cpu> {
  public:
    bool wants(int) const override { return false; }
    bool due(int) const override { return false; }
    int count_is_final_after() const override { return 0; }
    std::vector<std::string> gradient_columns() const override { return {"unheard_of"}; }
    densify_report run(int, const run_context<cpu>& c) override { return {c.count}; }
};

}  // namespace

TEST_CASE("a second strategy trains through the same interface, with its own interval, penalty and scores") {
    const gs::scene scene = small_scene();
    const auto made = make_engine_with({.make_strategy = make_copy_worst});
    engine& e = *made;
    train_options o;
    o.schedule.iterations = 45;
    o.schedule.sh_degree = 1;
    o.schedule.num_downscales = 0;
    o.max_cap = 1000;
    o.gradient = gs::accumulator::fixed;
    const gs::gaussians model = gs::from_points(scene.points, 1, 500, 1);
    calls.clear();
    e.set_views(scene.train, {});
    e.set_model(model);
    train(e, scene, o, {[](const progress&) {}, [](int) {}, [](int) {}});
    CHECK(calls ==
          std::vector<std::string>{"run 10", "adjust 501", "run 20", "adjust 502", "run 30", "adjust 503"});
    CHECK(e.count() == 503);
    const gs::gaussians trained = e.get_model();
    for (std::size_t i = 500; i < 503; ++i) CHECK(std::isfinite(trained.opacity[i]));
}

TEST_CASE("the work of a strategy after each step is done in that step, once") {
    const gs::scene scene = small_scene();
    const auto made = make_engine_with({.make_strategy = make_copy_worst});
    engine& e = *made;
    const gs::gaussians model = gs::from_points(scene.points, 0, 100, 1);
    e.set_views(scene.train, {});
    e.set_model(model);
    e.reserve();
    auto plan = plan_for(0);
    plan.rates = {};
    plan.rates[3] = 1e-30f;
    for (plan.iteration = 1; plan.iteration <= last_run + 5; ++plan.iteration) e.step(plan);
    const gs::gaussians stepped = e.get_model();
    for (std::size_t i = 0; i < 100; ++i)
        CHECK(stepped.opacity[i] == doctest::Approx(model.opacity[i] - penalty * last_run));
}

TEST_CASE("a strategy that is unknown or needs unknown statistics is refused") {
    const auto e = make_cpu_engine();
    training_setup setup;
    setup.densification.name = "magic";
    CHECK_THROWS_WITH_AS(e->begin(setup),
                         "no densification strategy is called \"magic\": choose adaptive, error or mcmc",
                         gs::error);
    const auto make_demanding = [](cpu&, const strategy_settings&,
                                   const training_facts&) -> std::unique_ptr<strategy<cpu>> {
        return std::make_unique<demanding>();
    };
    CHECK_THROWS_WITH_AS(make_engine_with({.make_strategy = make_demanding}),
                         doctest::Contains("needs the gradient column 'unheard_of'"), gs::error);
}
