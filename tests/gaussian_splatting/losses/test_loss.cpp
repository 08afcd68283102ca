// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../training/engine_with_parts.hpp"
#include "../training/engines.hpp"
#include "core/error.hpp"
#include "device/cpu/cpu.hpp"
#include "losses/loss_names.hpp"
#include "losses/losses.hpp"
#include "training/initialize.hpp"

namespace {

using gs::device::cpu;
using gs::train::fault_kind;

constexpr int width = 40, height = 27;
constexpr std::size_t pixels = width * height;

/// Opaque noise.
std::vector<std::uint8_t> noise() {
    std::mt19937 random(11);
    std::vector<std::uint8_t> rgba(4 * pixels, 255);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) rgba[i] = static_cast<std::uint8_t>(random() % 256);
    return rgba;
}

/// Differs from the target by 0.1 to 0.3 everywhere, so that |x - y| is differentiable nearby.
std::vector<float> render_near(const std::vector<std::uint8_t>& rgba) {
    std::mt19937 random(12);
    std::vector<float> render(3 * pixels);
    for (std::size_t i = 0; i < render.size(); ++i) {
        const float distance = 0.1f + 0.2f * static_cast<float>(random() % 1000) / 1000;
        const float target = static_cast<float>(rgba[4 * (i % pixels) + i / pixels]) / 255;
        render[i] = random() % 2 == 0 ? target + distance : target - distance;
    }
    return render;
}

double loss_of(gs::train::loss<float>& loss, const std::vector<float>& render) {
    loss.gradient(render.data(), {});
    return loss.take().loss;
}

struct scale_values {
    const float* from;
    float factor;
    float* to;
    void operator()(std::size_t i) const { to[i] = from[i] * factor; }
};

/// `l1_ssim` times 2^Exponent. Its `gradient_scale` is that of a loss 2^Declared times as large as `l1_ssim`.
template <int Exponent, int Declared>
class scaled final : public gs::train::loss<float> {
  public:
    explicit scaled(cpu& device) : device_(device), loss_(device) {}
    void set_target(const gs::train::target_image& target) override {
        loss_.set_target(target);
        gradient_.resize(3 * static_cast<std::size_t>(target.width) *
                         static_cast<std::size_t>(target.height));
    }
    const float* gradient(const float* render, const gs::raster::list_capacity& capacity) override {
        const float* gradient = loss_.gradient(render, capacity);
        device_.for_each_index(gradient_.size(),
                               scale_values{gradient, std::ldexp(1.0f, Exponent), gradient_.data()});
        return gradient_.data();
    }
    float gradient_scale() const override { return std::ldexp(loss_.gradient_scale(), Declared); }
    std::span<double> sums() const override { return loss_.sums(); }
    gs::train::loss_report take() override {
        gs::train::loss_report mean = loss_.take();
        mean.loss = std::ldexp(mean.loss, Exponent);
        return mean;
    }

  private:
    cpu& device_;
    gs::train::l1_ssim<cpu, float> loss_;
    cpu::buffer<float> gradient_;
};

struct outcome {
    gs::gaussians model;
    std::uint64_t unfit_sums;
    double loss;
};

/// Makes this loss for every name.
template <class Loss>
std::unique_ptr<gs::train::loss<float>> named(cpu& device, const std::string&) {
    return std::make_unique<Loss>(device);
}

/// Three deterministic steps with this loss.
outcome steps_with(std::unique_ptr<gs::train::loss<float>> (*make)(cpu&, const std::string&)) {
    const gs::scene scene = small_scene();
    const auto made = make_engine_with({.make_loss = make});
    gs::train::engine& engine = *made;
    engine.set_views(scene.train, {}, 0);
    engine.set_model(gs::from_points(scene.points, 0, 300, 1));
    engine.begin(setup_with(gs::accumulator::fixed));
    engine.reserve();
    auto plan = plan_for(0);
    for (plan.iteration = 1; plan.iteration <= 3; ++plan.iteration) engine.step(plan);
    const gs::train::step_report report = engine.take_report();
    return {engine.get_model(), report.faults[static_cast<std::size_t>(fault_kind::sum)].count,
            report.loss.loss};
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    return most;
}

}  // namespace

TEST_CASE("losses: each gradient is the derivative of the value, and gradient_scale is its magnitude") {
    const auto rgba = noise();
    const auto render = render_near(rgba);
    cpu device;
    for (const std::string& name : gs::train::loss_names()) {
        CAPTURE(name);
        const auto loss = gs::train::losses<cpu>::make(device, name);
        loss->set_target({rgba.data(), width, height});
        const float* at = loss->gradient(render.data(), {});
        const std::vector<float> gradient(at, at + render.size());
        loss->take();
        float largest = 0;
        for (const float g : gradient) largest = std::max(largest, std::abs(g));
        CHECK(largest <= 4 * loss->gradient_scale());
        CHECK(largest >= loss->gradient_scale() / 64);

        // Along the gradient's signs, and along values that alternate.
        for (const bool along_gradient : {true, false}) {
            constexpr float step = 1e-3f;
            std::vector<float> forward = render, backward = render;
            double expected = 0, magnitude = 0;
            for (std::size_t i = 0; i < render.size(); ++i) {
                const float direction =
                    along_gradient ? (gradient[i] < 0 ? -1.0f : 1.0f) : (i % 3 == 0 ? -1.0f : 1.0f);
                forward[i] += step * direction;
                backward[i] -= step * direction;
                expected += static_cast<double>(gradient[i]) * static_cast<double>(direction);
                magnitude += static_cast<double>(std::abs(gradient[i]));
            }
            const double found = (loss_of(*loss, forward) - loss_of(*loss, backward)) / (2 * step);
            CHECK(std::abs(found - expected) <= 2e-3 * magnitude);
        }
    }
}

TEST_CASE("losses: masked pixels have no gradient, and incomplete renders do not count") {
    auto rgba = noise();
    const auto render = render_near(rgba);
    for (std::size_t i = 0; i < pixels; i += 5) {
        std::fill_n(rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 3, std::uint8_t{255});
        rgba[4 * i + 3] = 0;
    }
    cpu device;
    for (const std::string& name : gs::train::loss_names()) {
        CAPTURE(name);
        const auto loss = gs::train::losses<cpu>::make(device, name);
        loss->set_target({rgba.data(), width, height, {}, true});
        const float* gradient = loss->gradient(render.data(), {});
        for (std::size_t i = 0; i < pixels; ++i) CHECK((gradient[i] == 0) == (i % 5 == 0));
        const double mean = loss->take().loss;
        const std::uint64_t required = 2;
        loss->gradient(render.data(), {});
        loss->gradient(std::vector<float>(3 * pixels, 7.0f).data(), {&required, 1});
        CHECK(loss->take().loss == mean);
    }
}

TEST_CASE("losses: an unknown name is an error that lists the names") {
    gs::train::training_setup setup;
    setup.loss = "l3";
    for (const auto make : engines())
        CHECK_THROWS_WITH_AS(make()->begin(setup),
                             doctest::Contains("no loss is called \"l3\": choose l1_ssim"), gs::error);
}

TEST_CASE("gradient_scale: a loss of another scale trains deterministically as well") {
    const outcome plain = steps_with(named<gs::train::l1_ssim<cpu, float>>);
    const outcome large = steps_with(named<scaled<10, 10>>);
    const outcome small = steps_with(named<scaled<-10, -10>>);
    CHECK(plain.unfit_sums == 0);
    for (const outcome* other : {&large, &small}) {
        CHECK(other->unfit_sums == 0);
        // Adam's steps, of about 0.02 each, depend on the scale only through its epsilon.
        CHECK(largest_difference(other->model.opacity, plain.model.opacity) < 1e-4);
    }
    CHECK(large.loss == doctest::Approx(1024 * plain.loss).epsilon(1e-6));
}

TEST_CASE("gradient_scale: sums beyond the headroom of a scale that is too small are reported") {
    const outcome plain = steps_with(named<gs::train::l1_ssim<cpu, float>>);
    const outcome wrong = steps_with(named<scaled<30, 0>>);
    CHECK(wrong.unfit_sums == 3);  // in each step
    CHECK(largest_difference(wrong.model.opacity, plain.model.opacity) > 1e-2);
    for (const float x : wrong.model.mean) CHECK(std::isfinite(x));
}
