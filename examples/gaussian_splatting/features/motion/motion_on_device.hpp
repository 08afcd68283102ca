// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../core/median.hpp"
#include "../device_feature.hpp"
#include "../learned_rows.hpp"
#include "motion_gradient.hpp"

namespace gs::features {

template <class Renderer>
class motion_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;

  public:
    explicit motion_on_device(typename Renderer::device_type& device)
        : of_training_(device), of_held_out_(device, true) {}

    void begin(const train::training_setup& setup) override {
        iterations_ = setup.facts.iterations;
        set_views(static_cast<std::size_t>(setup.facts.views));
    }
    void set_views(std::size_t training_views) override {
        scales_.clear();
        views_ = training_views;
    }

    /// Takes the scale of each view, and values 0 to 5 of its motion.
    void set_values(const std::vector<float>& values) override {
        constexpr std::size_t width = 2 + motion_width - 1;
        std::vector<float> rows;
        scales_.clear();
        for (std::size_t i = 0; i + width <= values.size(); i += width) {
            scales_.push_back({static_cast<double>(values[i]), static_cast<double>(values[i + 1])});
            rows.insert(rows.end(), &values[i + 2], &values[i] + width);
            rows.push_back(0);
        }
        of_training_.set(rows);
    }
    void change_values(const std::vector<float>& values) override { of_training_.change(values); }
    std::vector<float> values() const override {
        return learns() ? of_training_.get() : std::vector<float>{};
    }

    void exchange(state_archive& archive) override {
        if (learns()) of_training_.exchange(archive);
    }

    std::size_t memory_key(const step& s) const override {
        if (!learns()) return 0;
        return s.plan.iteration > first_iteration() ? 2 : 1;
    }
    camera seen_by(std::size_t view, const camera& given) override {
        if (!learns()) return given;
        scale_ = scales_[view];
        return with_motion(given, of_training_.of(view));
    }
    void learn_pose(const step& s, const float* sums) override {
        if (learns() && s.plan.iteration > first_iteration())
            of_training_.learn(s.plan.view, s, sums, rate_at(s.plan.iteration), sink());
    }

    void begin_refinement() override {
        if (!learns()) return;
        std::vector<double> depths, angles;
        for (const motion_scale& scale : scales_) {
            depths.push_back(scale.depth);
            angles.push_back(scale.angle);
        }
        scale_ = {median(depths), median(angles)};
        const float readout = of_training_.get().back();
        of_held_out_.set({small_motion, small_motion, 0, 0, 0, 0, readout});
    }
    camera refined(const camera& given) override {
        return learns() ? with_motion(given, of_held_out_.of(0)) : given;
    }
    void refine_pose(const step& s, const float* sums, double progress) override {
        if (learns())
            of_held_out_.learn(0, s, sums, static_cast<float>(most_rate * std::pow(0.01, progress)), sink());
    }

  private:
    bool learns() const { return !scales_.empty(); }
    camera with_motion(camera seen, const motion_values& values) const {
        seen.motion = motion_of(scale_, values);
        return seen;
    }
    auto sink() const {
        return [this](const train::ordered_sums& parts) { return motion_gradient(scale_, parts); };
    }

    /// The largest change in one step, in about a pixel.
    static constexpr double most_rate = 0.3;

    /// The iteration after which motions are learned. The first Gaussians are too large. A shorter motion
    /// would make them smaller, and would then hardly grow again, because its gradient vanishes at zero.
    int first_iteration() const { return iterations_.milestone(0.15); }

    /// Returns Adam's learning rate, which decays to a twentieth. It is lower if more steps use each view.
    float rate_at(int iteration) const {
        const double first =
            std::min(most_rate, 15 * static_cast<double>(views_) / static_cast<double>(iterations_.last()));
        return static_cast<float>(first * std::pow(0.05, std::pow(iterations_.progress(iteration), 2)));
    }

    learned_rows<typename Renderer::device_type, motion_width> of_training_, of_held_out_;
    std::vector<motion_scale> scales_;  ///< by training view; empty if the feature is off
    motion_scale scale_{};              ///< of the camera that was returned last
    iteration_plan iterations_;
    std::size_t views_ = 0;
};

}  // namespace gs::features
