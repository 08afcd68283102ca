// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "features/poses/pose_gradient.hpp"
#include "random_model.hpp"

namespace {

using namespace gs::features;

std::vector<given_pose> poses() {
    gs::camera pinhole{44, 33, 40, 42, 21, 17};
    pinhole.rotation = glm::mat3_cast(glm::normalize(glm::dquat(1, 0.3, -0.2, 0.4)));
    pinhole.translation = {0.2, -0.1, 3};
    gs::camera fisheye = pinhole;
    fisheye.fisheye = gs::fisheye({0.04, -0.012, 0.003, -0.0004});
    gs::camera panorama = gs::camera::panorama(64, 32);
    panorama.rotation = pinhole.rotation;
    panorama.translation = {0.1, 0.3, -0.2};
    given_pose of_rig{pinhole, 3};
    of_rig.leader = 0;
    of_rig.from_leader = glm::mat3_cast(glm::normalize(glm::dquat(1, 0.2, 0.5, -0.3)));
    of_rig.lever = {0.4, -0.3, 0.6};
    return {{pinhole, 3}, {fisheye, 2}, {panorama, std::numeric_limits<double>::infinity()}, of_rig};
}

}  // namespace

TEST_CASE("poses: the gradient by a pose change is that of central differences in double precision") {
    int jumps = 0;
    for (const given_pose& given : poses())
        for (const bool antialiased : {false, true})
            for (const pose_change& change :
                 {pose_change{}, pose_change{0.2f, -0.3f, 0.1f, 0.3f, -0.2f, 0.4f}}) {
                CAPTURE(static_cast<int>(given.camera.lens()));
                CAPTURE(antialiased);
                CAPTURE(change[0]);
                std::mt19937 random(3);
                const std::size_t values =
                    3u * static_cast<unsigned>(given.camera.width * given.camera.height);
                std::vector<float> weights(values);
                for (float& w : weights) w = std::normal_distribution<float>()(random);

                drawing<double> exact(antialiased);
                const auto loss = [&](const pose_change& at) {
                    const double* render = exact.draw(moved(given, at));
                    double sum = 0;
                    for (std::size_t i = 0; i < values; ++i)
                        sum += static_cast<double>(weights[i]) * render[i];
                    return sum;
                };
                drawing<float> trained(antialiased);
                trained.draw(moved(given, change));
                const float* sums =
                    trained.renderer.backward_to_splats(weights.data(), 1, gs::accumulator::native);
                constexpr std::size_t lanes = gs::device::cpu::narrow_warp::size;
                constexpr std::size_t warps = (model<float>::count + lanes - 1) / lanes;
                std::vector<float> parts(pose_width * warps);
                trained.renderer.backward_from_splats(
                    sums, 0, pose_gradient(derivatives_of(given, change), {parts.data(), warps}), nullptr);

                // A step over the edge of a splat has a jump, so steps are tiny, and two of them must agree.
                const auto difference = [&](unsigned k, float half_step) {
                    pose_change more = change, less = change;
                    more[k] += half_step;
                    less[k] -= half_step;
                    return (loss(more) - loss(less)) /
                           (static_cast<double>(more[k]) - static_cast<double>(less[k]));
                };
                std::array<double, pose_width> found{}, expected{};
                for (unsigned k = 0; k < pose_width; ++k) {
                    for (std::size_t w = 0; w < warps; ++w)
                        found[k] += static_cast<double>(parts[k * warps + w]);
                    expected[k] = difference(k, 2e-7f);
                }
                const double most =
                    std::abs(*std::ranges::max_element(found, {}, [](double x) { return std::abs(x); }));
                CHECK(most > 1);
                for (unsigned k = 0; k < pose_width; ++k) {
                    CAPTURE(k);
                    if (difference(k, 1e-7f) != doctest::Approx(expected[k]).epsilon(1e-4).scale(most)) {
                        ++jumps;
                        continue;
                    }
                    CHECK(found[k] == doctest::Approx(expected[k]).epsilon(2e-3).scale(most));
                }
            }
    CHECK(jumps <= 4);
}

TEST_CASE("poses: a Gaussian whose gradient is not finite has no part in the gradient of a pose") {
    const given_pose given = poses()[0];
    const auto gradient_without = [&](bool breaks) {
        drawing<float> trained(false);
        trained.draw(given.camera);
        const std::size_t values = 3u * static_cast<unsigned>(given.camera.width * given.camera.height);
        const std::vector<float> weights(values, 1);
        std::vector<float> sums(model<float>::count * gs::raster::record_stride);
        std::copy_n(trained.renderer.backward_to_splats(weights.data(), 1, gs::accumulator::fixed),
                    sums.size(), sums.begin());
        std::size_t drawn = 0;
        while (trained.renderer.tiles_of()[drawn] == 0 || sums[drawn * gs::raster::record_stride] == 0)
            ++drawn;
        for (unsigned k = 0; k < gs::raster::sum_count; ++k)
            sums[drawn * gs::raster::record_stride + k] = breaks ? std::nanf("") : 0;
        std::vector<float> parts(pose_width * model<float>::count);
        trained.renderer.backward_from_splats(
            sums.data(), 0, pose_gradient(derivatives_of(given, {}), {parts.data(), model<float>::count}),
            nullptr);
        return parts;
    };
    const auto without = gradient_without(false), broken = gradient_without(true);
    CHECK(std::ranges::any_of(without, [](float x) { return x != 0; }));
    for (std::size_t i = 0; i < without.size(); ++i) CHECK(broken[i] == without[i]);
}
