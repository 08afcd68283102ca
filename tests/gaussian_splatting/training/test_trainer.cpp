// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "densify/adaptive/adaptive_schedule.hpp"
#include "engine/sh_degree_state.hpp"
#include "features/sh_degree/sh_degree_feature.hpp"
#include "training/training.hpp"

namespace {

using gs::train::adaptive_config;
using gs::train::densify_config;
using gs::train::step_plan;

/// An engine without kernels: it has a number of Gaussians, which grow, and records its calls.
class recorder final : public gs::train::engine, gs::device::profiler, gs::train::rank_member {
  public:
    struct made_step {
        step_plan plan;
        int downscales;
    };
    std::vector<made_step> steps;
    std::vector<densify_config> densifications;
    std::vector<int> sizes_reserved;
    std::vector<std::size_t> counts;          ///< after each densification
    std::size_t dropped = 0;                  ///< in each
    std::vector<std::size_t> pruned_after;    ///< number of steps
    std::vector<std::size_t> adjusted_after;  ///< number of steps
    std::vector<int> degrees;
    std::vector<std::size_t> pruned_sh_after;  ///< number of steps
    double seconds = 0;                        ///< one per step
    double dropout = 0;

    explicit recorder(std::size_t count) : sh_(*this) {
        count_ = count;
        profiler_ = this;
        ranks_ = this;
    }

    void set_views(const std::vector<gs::view>&, const std::vector<gs::view>&, int,
                   const gs::photos::photo_plan&) override {}
    void set_model(const gs::gaussians&) override {}
    void join(gs::ranks::communicator&) override {}
    void prepare_renders() override {}
    gs::gaussians get_model() override { return {}; }
    void begin(const gs::train::training_setup& setup) override {
        dropout = setup.dropout;
        schedule_ = std::make_unique<gs::train::adaptive_schedule>(setup.densification.of<adaptive_config>(),
                                                                   setup.facts);
        timetable_ = schedule_.get();
    }
    void reserve(int downscales) override { sizes_reserved.push_back(downscales); }
    void step(const step_plan& plan, const std::vector<std::size_t>&) override {
        steps.push_back({plan, sizes_reserved.back()});
        ++seconds;
    }
    std::uint64_t densify(int iteration) override {
        if (schedule_->densifies(iteration)) {
            const densify_config c = schedule_->densify_config_at(iteration, count_);
            densifications.push_back(c);
            const std::size_t staying = count_ - dropped,
                              room = c.limits.cap - std::min(staying, c.limits.cap);
            count_ = staying + std::min({room, c.limits.most_births, staying});
            counts.push_back(count_);
        } else {
            CHECK(schedule_->prunes(iteration));
            CHECK(pruned_after.empty());
            pruned_after.push_back(steps.size());
        }
        return 0;
    }
    void adjust(int iteration) override {
        CHECK(static_cast<std::size_t>(iteration) == steps.size());
        adjusted_after.push_back(steps.size());
    }
    /// The loss of a step is its iteration.
    gs::train::step_report take_report() override {
        const auto first = reported_ + 1, last = steps.size();
        reported_ = last;
        return {{static_cast<double>(first + last) / 2, 1}, 0, {}};
    }
    gs::train::feature_state& feature(std::string_view) override { return sh_; }
    std::vector<float> render(const gs::camera&, const std::array<float, 3>&,
                              const gs::train::render_options&) override {
        return {};
    }
    gs::train::image_quality measure(std::size_t, const std::array<float, 3>&, std::vector<float>*) override {
        return {};
    }

  private:
    struct sh_state final : gs::train::sh_degree_state {
        explicit sh_state(recorder& r) : on(r) {}
        void set_degree(int degree) override { on.degrees.push_back(degree); }
        std::size_t prune(double change) override {
            CHECK(change == 0.01);
            CHECK((on.pruned_after.empty() || on.pruned_after.back() <= on.steps.size()));
            on.pruned_sh_after.push_back(on.steps.size());
            return 0;
        }
        recorder& on;
    };

    std::string device_name() const override { return "none"; }
    void sample_times(int) override {}
    gs::device::stage_times times() override { return {}; }
    std::uint64_t pairs() override { return 0; }
    std::size_t peak_device_bytes() const override { return 0; }
    bool shares_host_memory() const override { return true; }
    std::size_t used_device_bytes() const override { return 0; }
    std::size_t free_device_bytes() const override { return 0; }
    gs::device::memory_forecast forecast(std::size_t, int) const override { return {}; }
    void wait() override {}

    std::unique_ptr<gs::train::adaptive_schedule> schedule_;
    std::size_t reported_ = 0;  ///< the last step that was
    sh_state sh_;
};

/// A revision of the SH degree, if there is one.
struct revision {
    std::function<int(int)> degree;
    std::optional<double> prune_change;
};

/// What happens in 21 iterations, densifying after 4, 6, ..., 14.
std::unique_ptr<recorder> trained(gs::train::train_options o, std::size_t gaussians = 50,
                                  std::size_t dropped = 0, const revision& revision = {},
                                  gs::scene scene = {}) {
    scene.train.resize(3);
    o.schedule.iterations = 21;
    auto& adaptive = o.densification.of<adaptive_config>();
    adaptive.prune_share = adaptive.prune_share.value_or(0);
    adaptive.densify_from_iter = 2;
    adaptive.densification_interval = 2;
    adaptive.densify_until_iter = 15;
    o.max_cap = 100;
    auto made = std::make_unique<recorder>(gaussians);
    made->dropped = dropped;
    const gs::train::train_events quiet{[](const gs::train::progress&) {}, [](int) {}, [](int) {}};
    gs::train::training training(*made, scene, o, quiet);
    if (revision.degree) gs::features::schedule_revision(training, revision.degree, revision.prune_change);
    training.run();
    CHECK(made->steps.size() == 21);
    CHECK(made->densifications.size() == 6);
    return made;
}

}  // namespace

TEST_CASE(
    "by default every step learns all, three fifths from photos of half the size, and growth is free up to "
    "the "
    "cap") {
    const auto made = trained({});
    for (std::size_t i = 0; i < 21; ++i) {
        CHECK(made->steps[i].downscales == (i < 12 ? 1 : 0));
        CHECK(made->steps[i].plan.updates_sh);
    }
    CHECK(made->adjusted_after.size() == 21);
    for (const densify_config& c : made->densifications) {
        CHECK(c.limits.cap == 100);
        CHECK(c.limits.most_births == densify_config{}.limits.most_births);
        CHECK(c.limits.revised_opacity);
        CHECK(c.gradient == doctest::Approx(8e-5 * std::pow(1000, 0.25)));
    }
}

TEST_CASE("dropout: training has the share of the option, or a default without transparent photos") {
    gs::scene cut_out;
    cut_out.has_alpha = true;
    CHECK(trained({})->dropout == 0.05);
    CHECK(trained({}, 50, 0, {}, cut_out)->dropout == 0);
    gs::train::train_options o;
    o.schedule.dropout = 0.2;
    CHECK(trained(o)->dropout == 0.2);
    CHECK(trained(o, 50, 0, {}, cut_out)->dropout == 0.2);
}

TEST_CASE("photos grow by the schedule, and lists are sized anew for them") {
    gs::train::train_options o;
    o.schedule.num_downscales = 2;
    o.schedule.resolution_schedule = 6;
    const auto made = trained(o);
    for (std::size_t i = 0; i < 20; ++i) CHECK(made->steps[i].downscales == (i < 6 ? 2 : i < 12 ? 1 : 0));
}

TEST_CASE("colors that depend on direction learn every so many steps") {
    gs::train::train_options o;
    o.schedule.sh_update_interval = 4;
    const auto made = trained(o);
    for (std::size_t i = 0; i < 20; ++i) CHECK(made->steps[i].plan.updates_sh == ((i + 1) % 4 == 0));
}

TEST_CASE("a budget is grown to evenly from where training stands, whatever is dropped, and below the cap") {
    gs::train::train_options o;
    o.densification.of<adaptive_config>().budget = 60;
    o.densification.of<adaptive_config>().revised_opacity = false;
    const auto made = trained(o, 30);
    CHECK(made->counts == std::vector<std::size_t>{35, 40, 45, 50, 55, 60});
    for (const densify_config& c : made->densifications) {
        CHECK(c.gradient == 0);
        CHECK_FALSE(c.limits.revised_opacity);
    }
    CHECK(trained(o, 30, 5)->counts == std::vector<std::size_t>{30, 31, 34, 38, 44, 55});
    CHECK(trained(o, 70)->counts == std::vector<std::size_t>(6, 70));
    o.densification.of<adaptive_config>().budget = 120;
    CHECK(trained(o, 30)->densifications.back().limits.cap == 100);
}

TEST_CASE("pruning comes once the views have been round after densification") {
    gs::train::train_options o;
    CHECK(trained(o)->pruned_after.empty());
    o.densification.of<adaptive_config>().prune_share = 0.25;
    const auto made = trained(o);  // densifies before 15; three views
    CHECK(made->pruned_after == std::vector<std::size_t>{18});
    CHECK(made->sizes_reserved.size() == 1 + 1 + 6 + 1);
}

TEST_CASE("Gaussians lose bands once none comes or goes, and bands have been reviewed and had their time") {
    gs::train::train_options o;
    CHECK(trained(o)->pruned_sh_after.empty());
    const revision keeps{[](int degree) { return degree; }, 0.01};
    o.schedule.sh_degree = 1;
    o.schedule.sh_degree_interval = 2;
    CHECK(trained(o, 50, 0, keeps)->pruned_sh_after == std::vector<std::size_t>{15});  // densifies before
    o.densification.of<adaptive_config>().prune_share = 0.25;
    CHECK(trained(o, 50, 0, keeps)->pruned_sh_after == std::vector<std::size_t>{18});  // prunes
    o.schedule.sh_degree_interval = 10;
    for (const int degree : {0, 1, 2}) {
        CAPTURE(degree);
        const auto made = trained(o, 50, 0, {[degree](int) { return degree; }, 0.01});
        CHECK(made->degrees == std::vector{degree});
        // Reviewed after 20: none are there, or new ones have no time before the end.
        CHECK(made->pruned_sh_after == std::vector<std::size_t>(degree == 1 ? 1 : 0, 20));
    }
    o.densification.of<adaptive_config>().prune_share = 0;
    o.schedule.sh_degree_interval = 6;  // reviewed after 12, with two new ones the last time
    const revision adds{[](int) { return 2; }, 0.01};
    CHECK(trained(o, 50, 0, adds)->pruned_sh_after == std::vector<std::size_t>{18});
}

TEST_CASE("training: an iteration that only saves reports nothing, and its loss counts in the next report") {
    gs::scene scene;
    scene.train.resize(1);
    gs::train::train_options o;
    o.schedule.iterations = 200;
    o.save_iterations = {50};
    recorder engine(10);
    std::vector<std::pair<int, double>> reports;
    std::vector<int> saves;
    const gs::train::train_events events{
        .report = [&](const gs::train::progress& p) { reports.emplace_back(p.iteration, p.loss); },
        .save = [&](int iteration) { saves.push_back(iteration); },
        .test = [](int) {}};
    gs::train::training(engine, scene, o, events).run();
    CHECK(saves == std::vector{50});
    CHECK(reports == std::vector<std::pair<int, double>>{{100, 50.5}, {200, 150.5}});
}

TEST_CASE("training: the time of callbacks does not count") {
    gs::scene scene;
    scene.train.resize(1);
    gs::train::train_options o;
    o.schedule.iterations = 100;
    o.save_iterations = {10, 100};
    o.test_iterations = {20};
    recorder engine(10);
    std::vector<double> reported;
    const gs::train::train_events events{
        .report = [&](const gs::train::progress& p) { reported.push_back(p.seconds); },
        .save = [&](int) { engine.seconds += 1000; },
        .test = [&](int) { engine.seconds += 5000; },
        .seconds = [&] { return engine.seconds; }};
    CHECK(gs::train::training(engine, scene, o, events).run().seconds == 100);
    CHECK(reported == std::vector<double>{20, 100});
}
