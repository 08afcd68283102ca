// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <vector>

#include "edit/edit.hpp"
#include "engine/engine.hpp"
#include "model/spherical_harmonics.hpp"
#include "scene/look_at.hpp"

namespace {

namespace edit = gs::edit;

gs::gaussians random_gaussians(std::size_t count, int sh_degree) {
    gs::gaussians model;
    model.sh_degree = sh_degree;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto fill = [&](std::vector<float>& values, int width) {
        values.resize(count * static_cast<std::size_t>(width));
        for (float& value : values) value = uniform(random);
    };
    fill(model.mean, 3);
    fill(model.log_scale, 3);
    fill(model.quaternion, 4);
    fill(model.opacity, 1);
    fill(model.sh_constant, 3);
    fill(model.sh_rest, model.rest_width());
    return model;
}

/// Returns the first coordinate of each Gaussian.
std::vector<float> x_of(const gs::gaussians& model) {
    std::vector<float> x;
    for (std::size_t i = 0; i < model.count(); ++i) x.push_back(model.mean[3 * i]);
    return x;
}

/// Returns small opaque Gaussians at x = 0, 1, 2 and so on.
gs::gaussians row_of_gaussians(std::size_t count) {
    gs::gaussians model = random_gaussians(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        model.mean[3 * i] = static_cast<float>(i);
        model.mean[3 * i + 1] = model.mean[3 * i + 2] = 0;
    }
    model.log_scale.assign(3 * count, -5);
    model.opacity.assign(count, 3);
    return model;
}

glm::dmat3 some_rotation() { return glm::mat3_cast(glm::normalize(glm::dquat(0.3, -0.5, 0.7, 0.2))); }

/// Returns the red color in a direction.
double red(const gs::gaussians& model, std::size_t i, const glm::dvec3& direction) {
    double basis[16];
    gs::sh_basis(model.sh_degree, direction, basis);
    double color = basis[0] * double(model.sh_constant[3 * i]);
    const auto width = static_cast<std::size_t>(model.rest_width());
    for (std::size_t k = 0; k < width / 3; ++k)
        color += basis[k + 1] * double(model.sh_rest[i * width + 3 * k]);
    return color;
}

/// Returns the direction of an axis of a Gaussian's ellipsoid.
glm::dvec3 principal_axis(const gs::gaussians& model, std::size_t i, int axis) {
    const float* q = &model.quaternion[4 * i];
    return glm::mat3_cast(glm::normalize(glm::dquat(q[0], q[1], q[2], q[3])))[axis];
}

}  // namespace

TEST_CASE("edit: crop keeps the Gaussians with centers in the box, with all their parameters") {
    gs::gaussians model = random_gaussians(20, 2);
    for (std::size_t i = 0; i < 20; ++i) model.mean[3 * i] = static_cast<float>(i);
    model.antialiased = true;
    model.sky.assign(gs::sky_width, 0.5f);
    const gs::gaussians kept = edit::crop(model, {{3, -1, -1}, {5, 1, 1}});
    CHECK(x_of(kept) == std::vector<float>{3, 4, 5});
    CHECK(kept.antialiased);
    CHECK(kept.sky == model.sky);
    CHECK(kept.sh_degree == 2);
    CHECK(kept.sh_rest == std::vector<float>(model.sh_rest.begin() + 3 * 24, model.sh_rest.begin() + 6 * 24));
    CHECK(kept.quaternion ==
          std::vector<float>(model.quaternion.begin() + 12, model.quaternion.begin() + 24));
    CHECK(edit::crop(model, {{3, 2, -1}, {5, 3, 1}}).count() == 0);
}

TEST_CASE("edit: decimate keeps the Gaussians with the largest opacity times area, in their order") {
    gs::gaussians model = row_of_gaussians(6);
    model.opacity = {0, -4, 2, 0, 0, -1000};
    // Number 4 is large in one direction only; number 3 is a large disc.
    model.log_scale[3 * 4] = -4;
    model.log_scale[3 * 3 + 1] = model.log_scale[3 * 3 + 2] = -3;
    CHECK(x_of(edit::decimate(model, 3)) == std::vector<float>{2, 3, 4});
    CHECK(x_of(edit::decimate(model, 1)) == std::vector<float>{3});
    CHECK(x_of(edit::decimate(model, 5)) == std::vector<float>{0, 1, 2, 3, 4});
    CHECK(edit::decimate(model, 0).count() == 0);
    CHECK(edit::decimate(model, 6).count() == 6);
    CHECK(edit::decimate(model, 100).count() == 6);
}

TEST_CASE("edit: of equally important Gaussians, decimate keeps the first ones") {
    CHECK(x_of(edit::decimate(row_of_gaussians(9), 4)) == std::vector<float>{0, 1, 2, 3});
}

TEST_CASE("edit: remove_floaters removes transparent Gaussians and veils") {
    gs::gaussians model = row_of_gaussians(11);
    model.opacity[2] = -5;
    model.log_scale[3 * 5 + 1] = 4;  // at the center, and larger than the scene
    // Large, but as far away as it is large.
    model.mean[3 * 10] = 1000;
    model.log_scale[3 * 10] = 6;
    CHECK(x_of(edit::remove_floaters(model, {})) == std::vector<float>{0, 1, 3, 4, 6, 7, 8, 9, 1000});
    CHECK(edit::remove_floaters({}, {}).count() == 0);
}

TEST_CASE("edit: remove_floaters removes Gaussians that fewer than two cameras see") {
    const gs::gaussians model = row_of_gaussians(11);
    // Each camera looks along z at the Gaussians from `first` to `first` + 4.
    const auto camera_at = [](double first) {
        return gs::camera{.width = 40,
                          .height = 40,
                          .fx = 100,
                          .fy = 100,
                          .cx = 20,
                          .cy = 20,
                          .translation = {-first - 2, 0, 10}};
    };
    const std::vector<gs::camera> cameras{camera_at(0), camera_at(2), camera_at(6)};
    CHECK(x_of(edit::remove_floaters(model, cameras)) == std::vector<float>{2, 3, 4, 6});
    const std::vector<gs::camera> one{camera_at(0)};
    CHECK(edit::remove_floaters(model, one).count() == 11);
}

TEST_CASE("edit: a rotated model has rotated positions, ellipsoids and colors") {
    const glm::dmat3 rotation = some_rotation();
    for (int degree = 0; degree <= 3; ++degree) {
        CAPTURE(degree);
        const gs::gaussians model = random_gaussians(5, degree);
        const gs::gaussians turned = edit::rotate(model, rotation);
        for (std::size_t i = 0; i < model.count(); ++i) {
            const glm::dvec3 before(model.mean[3 * i], model.mean[3 * i + 1], model.mean[3 * i + 2]);
            const glm::dvec3 after(turned.mean[3 * i], turned.mean[3 * i + 1], turned.mean[3 * i + 2]);
            CHECK(glm::distance(after, rotation * before) < 1e-6);
            for (int axis = 0; axis < 3; ++axis)
                CHECK(glm::distance(principal_axis(turned, i, axis),
                                    rotation * principal_axis(model, i, axis)) < 1e-6);
            for (const glm::dvec3& d :
                 {glm::dvec3(1, 0, 0), glm::dvec3(0, 0.6, -0.8), glm::normalize(glm::dvec3(1, 2, -3))})
                CHECK(red(turned, i, rotation * d) == doctest::Approx(red(model, i, d)).epsilon(1e-5));
        }
        CHECK(turned.log_scale == model.log_scale);
        CHECK(turned.opacity == model.opacity);
    }
}

TEST_CASE("edit: the learned background turns with the model") {
    gs::gaussians model = random_gaussians(1, 3);
    gs::gaussians sky = model;
    for (std::size_t k = 0; k < 3; ++k) model.sky.push_back(sky.sh_constant[k]);
    model.sky.insert(model.sky.end(), model.sh_rest.begin(), model.sh_rest.end());
    const gs::gaussians turned = edit::rotate(model, some_rotation());
    for (std::size_t k = 0; k < gs::sky_width; ++k)
        CHECK(turned.sky[k] ==
              doctest::Approx(k < 3 ? turned.sh_constant[k] : turned.sh_rest[k - 3]).epsilon(1e-5));
}

TEST_CASE(
    "edit: Gaussians in place of the learned background look like it in all directions from the center") {
    gs::gaussians model = row_of_gaussians(5);
    model.sky.assign(gs::sky_width, 0.0f);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-0.1f, 0.1f);
    for (float& coefficient : model.sky) coefficient = uniform(random);
    const gs::gaussians with = edit::with_sky_gaussians(model);
    CHECK(with.count() == model.count() + edit::sky_count);
    CHECK(with.sky.empty());
    CHECK(std::equal(model.mean.begin(), model.mean.end(), with.mean.begin()));

    const auto engine = gs::train::make_cpu_engine();
    for (const glm::dvec3& target : {glm::dvec3(9, 1, 0), glm::dvec3(-9, 2, 3), glm::dvec3(2, 9, -9)}) {
        const gs::camera c = gs::look_at({2, 0.1, 0}, target, {0, 0, 1}, 64, 60);
        engine->set_model(model);
        const std::vector<float> before = engine->render(c, {0, 0, 0});
        engine->set_model(with);
        const std::vector<float> after = engine->render(c, {0, 0, 0});
        double squares = 0;
        for (std::size_t i = 0; i < before.size(); ++i)
            squares += std::pow(std::clamp(before[i], 0.0f, 1.0f) - std::clamp(after[i], 0.0f, 1.0f), 2);
        CHECK(squares / static_cast<double>(before.size()) < 1e-4);  // 40 dB
    }
}

TEST_CASE("edit: a model without a learned background gets no Gaussians for it, an empty one does") {
    const gs::gaussians model = row_of_gaussians(3);
    CHECK(edit::with_sky_gaussians(model).mean == model.mean);
    gs::gaussians empty;
    empty.sky.assign(gs::sky_width, 0.1f);
    CHECK(edit::with_sky_gaussians(empty).count() == edit::sky_count);
}

TEST_CASE("edit: upright turns any axis to -y by a rotation") {
    for (const glm::dvec3& up :
         {glm::dvec3(0, -1, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1),
          glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::normalize(glm::dvec3(1, 5, -2))}) {
        const glm::dmat3 turn = edit::upright(up);
        CHECK(glm::distance(turn * up, glm::dvec3(0, -1, 0)) < 1e-12);
        CHECK(glm::determinant(turn) == doctest::Approx(1));
        CHECK(glm::distance(turn[0], glm::cross(turn[1], turn[2])) < 1e-12);
    }
}
