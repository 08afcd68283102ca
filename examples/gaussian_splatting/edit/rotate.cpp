// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "../model/spherical_harmonics.hpp"
#include "edit.hpp"

namespace gs::edit {
namespace {

constexpr std::size_t most_coefficients = sh_coefficients(3);

/// A matrix for the SH coefficients of one color channel, up to degree 3.
using sh_matrix = std::array<std::array<double, most_coefficients>, most_coefficients>;

/// Returns the matrix that turns the coefficients of f(d) into those of f(R^-1 d). Its elements are
/// the integrals of Y_i(R d) Y_j(d) over the sphere. A Gauss-Legendre rule in z times a uniform rule
/// in the azimuth is exact for these polynomials of degree 6.
sh_matrix sh_rotation(const glm::dmat3& rotation) {
    const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2));
    const double outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
    const double weight_inner = (18 + std::sqrt(30.0)) / 36, weight_outer = (18 - std::sqrt(30.0)) / 36;
    const std::array<std::array<double, 2>, 4> nodes{
        {{-outer, weight_outer}, {-inner, weight_inner}, {inner, weight_inner}, {outer, weight_outer}}};
    constexpr int azimuths = 8;
    sh_matrix m{};
    for (const auto& [z, weight] : nodes)
        for (int step = 0; step < azimuths; ++step) {
            const double angle = 2 * std::numbers::pi * step / azimuths, r = std::sqrt(1 - z * z);
            const glm::dvec3 d(r * std::cos(angle), r * std::sin(angle), z);
            std::array<double, most_coefficients> before{}, after{};
            sh_basis(3, d, before.data());
            sh_basis(3, rotation * d, after.data());
            for (std::size_t i = 0; i < most_coefficients; ++i)
                for (std::size_t j = 0; j < most_coefficients; ++j)
                    m[i][j] += weight * 2 * std::numbers::pi / azimuths * after[i] * before[j];
        }
    return m;
}

/// Rotates the coefficients `first` to `end` - 1 of three channels. `values` begins with the
/// coefficient `first`, and is coefficient-major.
void rotate_sh(const sh_matrix& m, std::size_t first, std::size_t end, float* values) {
    std::array<double, 3 * most_coefficients> rotated{};
    for (std::size_t i = first; i < end; ++i)
        for (std::size_t j = first; j < end; ++j)
            for (std::size_t channel = 0; channel < 3; ++channel)
                rotated[3 * (i - first) + channel] += m[i][j] * double(values[3 * (j - first) + channel]);
    for (std::size_t k = 0; k < 3 * (end - first); ++k) values[k] = static_cast<float>(rotated[k]);
}

}  // namespace

gaussians rotate(const gaussians& model, const glm::dmat3& rotation) {
    gaussians result = model;
    const sh_matrix m = sh_rotation(rotation);
    const glm::dquat turn = glm::quat_cast(rotation);
    const auto width = static_cast<std::size_t>(model.rest_width());
    const auto coefficients = static_cast<std::size_t>(sh_coefficients(model.sh_degree));
    for (std::size_t i = 0; i < model.count(); ++i) {
        float* const p = &result.mean[3 * i];
        const glm::dvec3 moved = rotation * glm::dvec3(p[0], p[1], p[2]);
        float* const q = &result.quaternion[4 * i];
        const glm::dquat turned = turn * glm::dquat(q[0], q[1], q[2], q[3]);
        for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<float>(moved[static_cast<glm::length_t>(k)]);
        q[0] = static_cast<float>(turned.w);
        q[1] = static_cast<float>(turned.x);
        q[2] = static_cast<float>(turned.y);
        q[3] = static_cast<float>(turned.z);
        if (width > 0) rotate_sh(m, 1, coefficients, &result.sh_rest[i * width]);
    }
    if (!result.sky.empty()) rotate_sh(m, 0, most_coefficients, result.sky.data());
    return result;
}

glm::dmat3 upright(const glm::dvec3& up) {
    const glm::dvec3 target(0, -1, 0);
    const double cosine = glm::dot(up, target);
    // Opposite directions leave the axis of the half turn undetermined.
    if (cosine < -1 + 1e-12) return {1, 0, 0, 0, -1, 0, 0, 0, -1};
    const glm::dvec3 axis = glm::cross(up, target);
    const glm::dmat3 skew(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);
    return glm::dmat3(1) + skew + skew * skew / (1 + cosine);
}

}  // namespace gs::edit
