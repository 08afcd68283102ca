// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "training/trainer.hpp"

namespace {

using gs::train::densify_rule;
using gs::train::step_plan;

/// Has nothing but a number of Gaussians, which grow as they may, and notes what it was told to do.
class recorder final : public gs::train::engine {
  public:
    struct made_step {
        step_plan plan;
        int downscales;
    };
    std::vector<made_step> steps;
    std::vector<densify_rule> rules;
    std::vector<int> sizes_reserved;
    std::vector<std::size_t> counts;  ///< after each densification
    std::size_t dropped = 0;          ///< in each

    explicit recorder(std::size_t count) : count_(count) {}

    std::string device_name() const override { return "none"; }
    void set_views(const std::vector<gs::view>&, const std::vector<gs::view>&, int) override {}
    void set_model(const gs::gaussians&) override {}
    gs::gaussians get_model() override { return {}; }
    std::size_t count() const override { return count_; }
    void set_downscales(int times) override { downscales_ = times; }
    void step(const step_plan& plan) override {
        CHECK(sizes_reserved.back() == downscales_);
        steps.push_back({plan, downscales_});
    }
    std::uint64_t densify(const densify_rule& rule) override {
        rules.push_back(rule);
        const std::size_t staying = count_ - dropped, room = rule.cap - std::min(staying, rule.cap);
        count_ = staying + std::min({room, rule.most_births, staying});
        counts.push_back(count_);
        return 0;
    }
    std::vector<std::size_t> pruned_after;  ///< so many steps
    void prune(double share) override {
        CHECK(share == 0.25);
        CHECK(pruned_after.empty());
        pruned_after.push_back(steps.size());
    }
    void set_loss(const std::string& name) override { CHECK(name == "l1_ssim"); }
    void reset_opacity(float) override {}
    std::vector<gs::train::exposure> exposures() override { return {}; }
    void set_exposures(const std::vector<gs::train::exposure>&) override {}
    void set_test_exposures(const std::vector<gs::train::exposure>&) override {}
    void centre_exposures() override {}
    void set_depth_fits(const std::vector<gs::depth_fit>&) override {}
    std::vector<std::size_t> cleared_after;  ///< so many steps
    void clear_cameras() override { cleared_after.push_back(steps.size()); }
    void reserve() override { sizes_reserved.push_back(downscales_); }
    gs::train::loss_report take_training_loss() override { return {}; }
    std::uint64_t skipped_steps() override { return 0; }
    gs::train::findings take_findings() override { return {}; }
    std::vector<float> render(const gs::camera&, const std::array<float, 3>&, int) override { return {}; }
    std::vector<int> degrees;
    void set_sh_degree(int degree) override { degrees.push_back(degree); }
    std::vector<std::size_t> dropped_bands_after;  ///< so many steps
    std::size_t drop_bands(double change, gs::accumulator) override {
        CHECK(change == 0.01);
        CHECK((pruned_after.empty() || pruned_after.back() <= steps.size()));
        dropped_bands_after.push_back(steps.size());
        return 0;
    }
    gs::train::image_quality measure(std::size_t, const std::array<float, 3>&, std::vector<float>*) override {
        return {};
    }
    void sample_times(int) override {}
    gs::device::stage_times times() override { return {}; }
    std::uint64_t pairs() override { return 0; }
    std::size_t peak_device_bytes() const override { return 0; }
    void wait() override {}

  private:
    std::size_t count_;
    int downscales_ = 7;  // of some training before
};

/// What happens in 21 iterations, densifying after 4, 6, ..., 14.
recorder trained(gs::train::train_options o, std::size_t gaussians = 50, std::size_t dropped = 0) {
    gs::scene scene;
    scene.train.resize(3);
    o.schedule.iterations = 21;
    o.schedule.prune_share = o.schedule.prune_share.value_or(0);
    o.schedule.densify_from_iter = 2;
    o.schedule.densification_interval = 2;
    o.schedule.densify_until_iter = 15;
    o.max_cap = 100;
    recorder made(gaussians);
    made.dropped = dropped;
    const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    gs::train::train(made, scene, o, quiet);
    CHECK(made.steps.size() == 21);
    CHECK(made.rules.size() == 6);
    return made;
}

}  // namespace

TEST_CASE(
    "by default every step learns all, a fifth from photos of half the size, and growth is free up to the "
    "cap") {
    const recorder made = trained({});
    for (std::size_t i = 0; i < 21; ++i) {
        CHECK(made.steps[i].downscales == (i < 4 ? 1 : 0));
        CHECK(made.steps[i].plan.updates_sh);
    }
    CHECK(made.cleared_after == std::vector<std::size_t>{2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 21});
    for (const densify_rule& rule : made.rules) {
        CHECK(rule.cap == 100);
        CHECK(rule.most_births == densify_rule{}.most_births);
        CHECK(rule.revised_opacity);
        CHECK(rule.gradient == doctest::Approx(8e-5 * std::pow(1000, 0.25)));
    }
}

TEST_CASE("photos grow by the schedule, and lists are sized anew for them") {
    gs::train::train_options o;
    o.schedule.num_downscales = 2;
    o.schedule.resolution_schedule = 6;
    const recorder made = trained(o);
    for (std::size_t i = 0; i < 20; ++i) CHECK(made.steps[i].downscales == (i < 6 ? 2 : i < 12 ? 1 : 0));
}

TEST_CASE("colours that depend on direction learn every so many steps") {
    gs::train::train_options o;
    o.schedule.sh_update_interval = 4;
    const recorder made = trained(o);
    for (std::size_t i = 0; i < 20; ++i) CHECK(made.steps[i].plan.updates_sh == ((i + 1) % 4 == 0));
}

TEST_CASE("a budget is grown to evenly from where training stands, whatever is dropped, and below the cap") {
    gs::train::train_options o;
    o.budget = 60;
    o.revised_opacity = false;
    const recorder made = trained(o, 30);
    CHECK(made.counts == std::vector<std::size_t>{35, 40, 45, 50, 55, 60});
    for (const densify_rule& rule : made.rules) {
        CHECK(rule.gradient == 0);
        CHECK_FALSE(rule.revised_opacity);
    }
    CHECK(trained(o, 30, 5).counts == std::vector<std::size_t>{30, 31, 34, 38, 44, 55});
    CHECK(trained(o, 70).counts == std::vector<std::size_t>(6, 70));
    o.budget = 120;
    CHECK(trained(o, 30).rules.back().cap == 100);
}

TEST_CASE(
    "pruning comes once the views have been round after densification, and they are watched until then") {
    gs::train::train_options o;
    CHECK(trained(o).pruned_after.empty());
    o.schedule.prune_share = 0.25;
    const recorder made = trained(o);  // densifies before 15; three views
    CHECK(made.pruned_after == std::vector<std::size_t>{18});
    for (std::size_t i = 0; i < 20; ++i) CHECK(made.steps[i].plan.watch == (i < 18));
    CHECK(made.sizes_reserved.size() == 1 + 1 + 6 + 1);
}

TEST_CASE("Gaussians lose bands once none comes or goes, and bands have been reviewed and had their time") {
    gs::train::train_options o;
    CHECK(trained(o).dropped_bands_after.empty());
    o.band_change = 0.01;
    o.schedule.sh_degree = 1;
    o.schedule.sh_degree_interval = 2;
    CHECK(trained(o).dropped_bands_after == std::vector<std::size_t>{15});  // densifies before
    o.schedule.prune_share = 0.25;
    CHECK(trained(o).dropped_bands_after == std::vector<std::size_t>{18});  // prunes
    o.schedule.sh_degree_interval = 10;
    for (const int degree : {0, 1, 2}) {
        CAPTURE(degree);
        o.review_bands = [degree](int) { return degree; };
        const recorder made = trained(o);
        CHECK(made.degrees == std::vector{degree});
        // Reviewed after 20: none are there, or new ones have no time before the end.
        CHECK(made.dropped_bands_after == std::vector<std::size_t>(degree == 1 ? 1 : 0, 20));
    }
    o.schedule.prune_share = 0;
    o.schedule.sh_degree_interval = 6;  // reviewed after 12, with two new ones the last time
    CHECK(trained(o).dropped_bands_after == std::vector<std::size_t>{18});
}
