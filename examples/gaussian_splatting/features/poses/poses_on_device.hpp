// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "../../core/error.hpp"
#include "../../core/median.hpp"
#include "../device_feature.hpp"
#include "../learned_rows.hpp"
#include "pose_gradient.hpp"
#include "pose_start.hpp"

namespace gs::features {

template <class Renderer>
class poses_on_device final : public device_feature<Renderer> {
    using step = features::step<Renderer>;

  public:
    explicit poses_on_device(typename Renderer::device_type& device)
        : of_training_(device), of_held_out_(device, true) {}

    void begin(const train::training_setup& setup) override {
        iterations_ = setup.facts.iterations;
        set_views(static_cast<std::size_t>(setup.facts.views));
    }
    void set_views(std::size_t training_views) override {
        given_numbers_.clear();
        largest_steps_.clear();
        views_ = training_views;
        of_training_.set(std::vector<float>(pose_width * training_views));
    }

    /// Takes `initial_values`, or an empty list. Throws `error` if they are not those of this many views.
    void set_values(const std::vector<float>& values) override {
        if (!values.empty() && values.size() != start_width * views_)
            throw error("the effect poses has " + std::to_string(values.size()) + " initial values, but " +
                        std::to_string(views_) + " training photos need " +
                        std::to_string(start_width * views_));
        set_views(views_);
        std::vector<float> changes;
        for (const pose_start& start : starts_in(values)) {
            const float* numbers = values.data() + start_width * largest_steps_.size();
            given_numbers_.insert(given_numbers_.end(), numbers, numbers + given_width);
            changes.insert(changes.end(), start.change.begin(), start.change.end());
            largest_steps_.push_back(start.largest_step);
        }
        if (learns()) of_training_.set(changes);
        leaders_ = 0;
        for (std::size_t view = 0; view < largest_steps_.size(); ++view)
            leaders_ += from_numbers({}, numbers_of_view(view)).leader ? 0 : 1;
    }
    void change_values(const std::vector<float>& values) override { of_training_.change(values); }
    std::vector<float> values() const override { return of_training_.get(); }

    void exchange(state_archive& archive) override {
        if (learns()) of_training_.exchange(archive);
    }

    std::size_t memory_key(const step&) const override { return learns() ? 1 : 0; }
    camera seen_by(std::size_t view, const camera& given) override {
        if (!learns()) return given;
        given_ = from_numbers(given, numbers_of_view(view));
        change_ = of_training_.of(given_.leader.value_or(view));
        return moved(given_, change_);
    }
    void learn_pose(const step& s, const float* sums) override {
        if (!learns()) return;
        const std::size_t leader = given_.leader.value_or(static_cast<std::size_t>(s.plan.view));
        of_training_.learn(leader, s, sums, std::min(largest_steps_[leader], rate_at(s.plan.iteration)),
                           sink());
    }

    void begin_refinement() override {
        if (!learns()) return;
        of_held_out_.set(std::vector<float>(pose_width));
        std::vector<double> depths;
        for (std::size_t at = 0; at < given_numbers_.size(); at += given_width)
            depths.push_back(static_cast<double>(given_numbers_[at]));
        given_ = {};
        given_.depth = median(depths);
    }
    camera refined(const camera& given) override {
        if (!learns()) return given;
        change_ = of_held_out_.of(0);
        given_.camera = given;
        return moved(given_, change_);
    }
    void refine_pose(const step& s, const float* sums, double progress) override {
        if (!learns()) return;
        of_held_out_.learn(0, s, sums, step_from_given * static_cast<float>(std::pow(0.05, progress)),
                           sink());
    }

  private:
    bool learns() const { return !given_numbers_.empty(); }
    auto sink() const {
        return [this](const train::ordered_sums& parts) {
            return pose_gradient(derivatives_of(given_, change_), parts);
        };
    }
    std::span<const float, given_width> numbers_of_view(std::size_t view) const {
        return std::span(given_numbers_).subspan(given_width * view).template first<given_width>();
    }

    /// Returns Adam's learning rate, which decays to a fifth. It is lower if more steps train each change.
    float rate_at(int iteration) const {
        const double first =
            std::min(static_cast<double>(step_from_given),
                     0.15 * static_cast<double>(leaders_) / static_cast<double>(iterations_.last()));
        return static_cast<float>(first * std::pow(0.2, iterations_.progress(iteration)));
    }

    learned_rows<typename Renderer::device_type, pose_width> of_training_, of_held_out_;
    std::vector<float>
        given_numbers_;     ///< of all training views: see `numbers_of`; empty if the feature is off
    given_pose given_{};    ///< of the camera that was returned last
    pose_change change_{};  ///< of the same camera
    iteration_plan iterations_;
    std::size_t views_ = 0, leaders_ = 0;  ///< number of views, and of those that are trained
    std::vector<float> largest_steps_;     ///< by training view
};

}  // namespace gs::features
