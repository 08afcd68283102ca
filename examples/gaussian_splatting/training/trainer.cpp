// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "trainer.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <random>
#include <utility>

#include "../core/error.hpp"

namespace gs::train {

namespace {

using clock = std::chrono::steady_clock;

double seconds_since(clock::time_point from) {
    return std::chrono::duration<double>(clock::now() - from).count();
}

/// Every view once before any comes again, each time in another order.
class view_order {
  public:
    view_order(std::size_t views, std::uint64_t seed) : order_(views), next_(views), random_(seed) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
    }
    std::size_t next() {
        if (next_ == order_.size()) {
            // Not std::shuffle, whose order is the library's own business.
            for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random_() % i]);
            next_ = 0;
        }
        return order_[next_++];
    }

  private:
    std::vector<std::size_t> order_;
    std::size_t next_;
    std::mt19937_64 random_;
};

std::array<float, 3> random_colour(std::mt19937_64& random) {
    const auto channel = [&] { return static_cast<float>(random() >> 40) * 0x1p-24f; };
    const float r = channel(), g = channel(), b = channel();
    return {r, g, b};
}

densify_rule rule_at(int iteration, const schedule& schedule, const train_options& options,
                     std::size_t gaussians) {
    densify_rule rule;
    rule.dense_scale = static_cast<float>(0.01 * schedule.extent);
    rule.gradient = static_cast<float>(schedule.growth_threshold());
    rule.cap = options.max_cap;
    if (options.budget > 0) {
        const auto left = static_cast<std::size_t>(schedule.densifications_from(iteration));
        rule.gradient = 0;
        rule.cap = std::min(rule.cap, options.budget);
        rule.most_births = options.budget > gaussians ? (options.budget - gaussians + left - 1) / left : 0;
    }
    rule.revised_opacity = options.revised_opacity;
    rule.seed = options.seed;
    rule.step = static_cast<std::uint64_t>(iteration);
    return rule;
}

/// What an engine found not to be finite, with the view it was found in.
class finite_watch {
  public:
    void shows(std::size_t view) { views_.push_back(view); }

    /// Of the iterations since the last look, the last of which is `iteration`: see `train`.
    void look(engine& engine, const scene& scene, int iteration, const train_events& events,
              train_result& result) {
        const findings found = engine.take_findings();
        const auto& loss = found[static_cast<std::size_t>(fault::loss)];
        const auto& value = found[static_cast<std::size_t>(fault::parameter)];
        const auto& gradient = found[static_cast<std::size_t>(fault::gradient)];
        const auto& sum = found[static_cast<std::size_t>(fault::sum)];
        const auto where = [&](const finding& f) {
            const std::size_t back = static_cast<std::size_t>(iteration - f.iteration) + 1;
            return "iteration " + std::to_string(f.iteration) + ", view " +
                   scene.train[views_[views_.size() - back]].name;
        };
        const auto of = [](const finding& f) {
            return std::string(parameter_names[static_cast<std::size_t>(f.parameter)]) + " of Gaussian " +
                   std::to_string(f.gaussian);
        };
        if (gradient.count > 0 && result.left_out_gradients == 0)
            events.warn(where(gradient) + ": the gradient of " + of(gradient) +
                        " is not finite or too large to square; such gradients are left out");
        if (sum.count > 0 && result.left_out_sums == 0)
            events.warn(where(sum) +
                        ": a sum of gradients exceeds the fixed-point range that gradient_scale() of the loss "
                        "allows; such sums are left out");
        result.left_out_gradients += gradient.count;
        result.left_out_sums += sum.count;
        if (value.count > 0)
            throw error(where(value) + ": " + of(value) + " would not be finite; training ends here");
        if (loss.count > 0) throw error(where(loss) + ": the loss is not finite; training ends here");
        views_.clear();
    }

  private:
    std::vector<std::size_t> views_;  ///< of the iterations since the last look
};

}  // namespace

std::size_t default_cap(const scene& scene) {
    std::size_t pixels = 0;
    for (const view& v : scene.train)
        pixels += static_cast<std::size_t>(v.camera.width) * static_cast<std::size_t>(v.camera.height);
    return std::max<std::size_t>(pixels / 32, 10000);
}

train_result train(engine& engine, const scene& scene, const train_options& options,
                   const train_events& events) {
    schedule schedule = options.schedule;
    schedule.extent = scene.extent();
    schedule.white = scene.has_alpha && options.background.colour == std::array<float, 3>{1, 1, 1};

    constexpr int report_every = 100;
    constexpr int reserve_every = 500;  // between densifications lists grow slowly
    view_order order(scene.train.size(), options.seed);
    std::mt19937_64 colours(options.seed + 1);
    finite_watch watch;
    train_result result;
    const int views = static_cast<int>(scene.train.size());
    const int review_after = schedule.bands_are_known_after();  // once, whatever comes of it
    int drop_bands_after = std::max(review_after, schedule.count_is_final_after(views));
    const bool exposes = !options.exposures.empty();
    if (exposes) engine.set_exposures(options.exposures);
    if (!options.depth_fits.empty()) engine.set_depth_fits(options.depth_fits);
    engine.take_findings();  // of steps that are not ours
    engine.set_loss(options.loss);
    int downscales = schedule.downscales_at(1);
    engine.set_downscales(downscales);
    engine.reserve();
    engine.wait();
    const auto start = clock::now();
    double outside = 0;  // in callbacks

    for (int iteration = 1; iteration <= schedule.iterations; ++iteration) {
        if (schedule.downscales_at(iteration) != downscales) {
            downscales = schedule.downscales_at(iteration);
            engine.set_downscales(downscales);
            engine.reserve();
        }
        step_plan plan;
        plan.view = order.next();
        plan.sh_degree = schedule.sh_degree_at(iteration);
        plan.updates_sh = schedule.updates_sh(iteration);
        plan.background = options.background.random ? random_colour(colours) : options.background.colour;
        plan.gradient = options.gradient;
        plan.rates = schedule.rates_at(iteration);
        plan.watch = schedule.watches(iteration, views);
        plan.iteration = iteration;
        if (exposes) plan.exposure_rate = schedule.exposure_rate_at(iteration, views);
        plan.sky_rate = schedule.sky_rate_at(iteration);
        if (!options.depth_fits.empty()) plan.depth_weight = schedule.depth_weight_at(iteration);
        engine.step(plan);
        watch.shows(plan.view);

        const bool prunes = iteration == schedule.prune_after(views);
        const bool reviews = options.review_bands && iteration == review_after;
        const bool may_drop_bands =
            options.band_change && iteration == drop_bands_after && iteration < schedule.iterations;
        if (schedule.densifies(iteration) || prunes || reviews || may_drop_bands ||
            iteration % reserve_every == 0) {
            engine.wait();
            const auto from = clock::now();
            if (schedule.densifies(iteration))
                result.silent_gaussians =
                    std::max(result.silent_gaussians,
                             engine.densify(rule_at(iteration, schedule, options, engine.count())));
            if (prunes) engine.prune(schedule.share_to_prune());
            if (reviews) {
                const int before =
                    std::exchange(schedule.sh_degree, options.review_bands(schedule.sh_degree));
                engine.set_sh_degree(schedule.sh_degree);
                if (schedule.sh_degree > before)  // new ones have their time first
                    drop_bands_after = std::max(drop_bands_after, iteration + schedule.sh_degree_interval);
            }
            if (may_drop_bands && iteration == drop_bands_after && schedule.sh_degree > 0) {
                const std::size_t banded = engine.drop_bands(*options.band_change, options.gradient);
                if (banded < engine.count()) result.banded = banded;
            }
            engine.reserve();
            result.densify_seconds += seconds_since(from);
        }
        if (schedule.resets_opacity(iteration)) engine.reset_opacity(schedule::reset_opacity);

        const bool last = iteration == schedule.iterations;
        if (exposes && (iteration % views == 0 || last)) engine.centre_exposures();
        if (iteration % schedule.densification_interval == 0 || last) engine.clear_cameras();
        const bool tests = options.test_iterations.contains(iteration);
        const bool saves = options.save_iterations.contains(iteration);
        if (iteration % report_every == 0 || last || tests || saves)
            watch.look(engine, scene, iteration, events, result);
        if (iteration % report_every == 0 || last || tests) {
            const loss_report mean = engine.take_training_loss();
            events.report({iteration, schedule.iterations, mean.loss, mean.psnr(), engine.count(),
                           seconds_since(start) - outside});
        }
        if (tests || saves) {
            engine.wait();
            const auto aside = clock::now();
            if (tests) events.test(iteration);
            if (saves) events.save(iteration);
            outside += seconds_since(aside);
        }
    }
    engine.wait();
    result.seconds = seconds_since(start) - outside;
    result.skipped_steps = engine.skipped_steps();
    result.sh_degree = schedule.sh_degree;
    if (exposes) result.exposures = engine.exposures();
    return result;
}

}  // namespace gs::train
