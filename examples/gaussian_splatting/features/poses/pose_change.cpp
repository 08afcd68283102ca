// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "pose_change.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "../../core/median.hpp"
#include "../../core/solve.hpp"

namespace gs::features {
namespace {

/// The functions of an angle in Rodrigues' formula and in its derivative. Series replace them near
/// zero, where they are quotients of zeros.
struct angle_functions {
    double sine;          ///< sin(a) / a
    double cosine;        ///< (1 - cos(a)) / a^2
    double rest_of_sine;  ///< (a - sin(a)) / a^3

    explicit angle_functions(double angle) {
        const double square = angle * angle;
        if (angle < 1e-3) {
            sine = 1 - square / 6;
            cosine = 0.5 - square / 24;
            rest_of_sine = 1.0 / 6 - square / 120;
        } else {
            sine = std::sin(angle) / angle;
            cosine = 2 * std::pow(std::sin(angle / 2) / angle, 2);
            rest_of_sine = (1 - sine) / square;
        }
    }
};

glm::dmat3 cross_product_by(const glm::dvec3& v) {
    return {0, v.z, -v.y, -v.z, 0, v.x, v.y, -v.x, 0};  // columns
}

glm::dvec3 shift_of(const pose_change& change) { return {change[3], change[4], change[5]}; }

/// Returns the linear map from values 3 to 5 to the turn that keeps a point on the axis in its place.
glm::dmat3 turn_by_shift(const given_pose& given) {
    const double angle = shift_unit / given.depth;
    return {0, angle, 0, -angle, 0, 0, 0, 0, 0};  // columns
}

/// Returns the whole turn of a change.
glm::dvec3 turn_of(const given_pose& given, const pose_change& change) {
    return glm::dvec3(change[0], change[1], change[2]) + turn_by_shift(given) * shift_of(change);
}

/// Returns the given world-to-camera rotation of the leader.
glm::dmat3 leader_rotation(const given_pose& given) {
    return glm::transpose(given.from_leader) * given.camera.rotation;
}

glm::dmat3 rotation_by(const glm::dvec3& turn) {
    const angle_functions f(glm::length(turn));
    const glm::dmat3 k = cross_product_by(turn);
    return glm::dmat3(1) + f.sine * k + f.cosine * (k * k);
}

/// Returns the rotation vector of a rotation by less than half a turn.
glm::dvec3 rotation_vector_of(const glm::dmat3& r) {
    const glm::dvec3 twice_sine(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
    const double sine = glm::length(twice_sine) / 2, cosine = (r[0][0] + r[1][1] + r[2][2] - 1) / 2;
    return sine > 0 ? std::atan2(sine, cosine) / (2 * sine) * twice_sine : glm::dvec3(0);
}

glm::dmat3 left_jacobian(const glm::dvec3& turn) {
    const angle_functions f(glm::length(turn));
    const glm::dmat3 k = cross_product_by(turn);
    return glm::dmat3(1) + f.cosine * k + f.rest_of_sine * (k * k);
}

/// A least-squares fit of the 13 numbers of a common motion: rotation, translation and scaling of the
/// scene, and a pose change in camera space.
class common_motion {
  public:
    static constexpr std::size_t unknowns = 13;
    using row = std::array<double, unknowns>;
    using rows = std::array<row, pose_width>;  ///< the change of a view by each unknown

    static rows rows_of(const given_pose& given) {
        rows all{};
        const auto set = [&](std::size_t unknown, const glm::dvec3& whole_turn, const glm::dvec3& shift) {
            const glm::dvec3 turn = whole_turn - turn_by_shift(given) * shift;
            for (int k = 0; k < 3; ++k) {
                all[static_cast<std::size_t>(k)][unknown] = turn[k];
                all[static_cast<std::size_t>(k) + 3][unknown] = shift[k];
            }
        };
        const glm::dvec3 center = given.camera.center();
        const auto in_camera = [&](const glm::dvec3& v) { return given.camera.rotation * v; };
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 axis(0);
            axis[k] = 1;
            const auto at = static_cast<std::size_t>(k);
            // A camera that turns with the scene has the opposite change of its world-to-camera rotation.
            set(at, -in_camera(axis), in_camera(glm::cross(axis, center)) / shift_unit);
            set(at + 3, glm::dvec3(0), in_camera(axis));
            set(at + 7, axis, glm::dvec3(0));
            set(at + 10, glm::dvec3(0), axis);
        }
        set(6, glm::dvec3(0), in_camera(center));
        return all;
    }

    void add(const row& by_unknown, double value) {
        for (std::size_t i = 0; i < unknowns; ++i) {
            right_[i] += by_unknown[i] * value;
            for (std::size_t j = 0; j < unknowns; ++j) normal_[i][j] += by_unknown[i] * by_unknown[j];
        }
    }

    /// Returns the fit. The unknowns of a few cameras depend on each other, so a small multiple of the
    /// identity is added.
    row fit() const {
        double trace = 0;
        for (std::size_t i = 0; i < unknowns; ++i) trace += normal_[i][i];
        auto normal = normal_;
        for (std::size_t i = 0; i < unknowns; ++i) normal[i][i] += 1e-6 * trace;
        return solve(normal, right_);
    }

  private:
    std::array<row, unknowns> normal_{};
    row right_{};
};

/// Lets the cameras of each rig follow the first of them.
void follow_leaders(const std::vector<view>& views, std::vector<given_pose>& poses) {
    std::map<std::uint32_t, std::size_t> leaders;
    for (std::size_t v = 0; v < views.size(); ++v) {
        if (!views[v].rig_frame) continue;
        const std::size_t leader = leaders.emplace(*views[v].rig_frame, v).first->second;
        if (leader == v) continue;
        const camera &own = poses[v].camera, &leading = poses[leader].camera;
        poses[v].depth = poses[leader].depth;
        poses[v].from_leader = own.rotation * glm::transpose(leading.rotation);
        poses[v].lever = leading.rotation * (own.center() - leading.center());
        poses[v].leader = leader;
    }
}

}  // namespace

std::vector<given_pose> given_poses(const scene& scene) {
    constexpr std::size_t most_points = 20000, least_points = 10;
    constexpr double least_depth = internal_extent / 20;  // nearer, a shift would turn the camera a lot
    const std::size_t step = scene.points.size() / most_points + 1;
    std::vector<given_pose> poses;
    for (const view& v : scene.train) {
        const camera& c = v.camera;
        std::vector<double> depths;
        for (std::size_t i = 0; i < scene.points.size(); i += step)
            if (const auto seen = c.see(scene.points[i].position);
                seen && seen->x >= 0 && seen->y >= 0 && seen->x < c.width && seen->y < c.height)
                depths.push_back(seen->depth);
        const double depth = c.is_panorama                  ? std::numeric_limits<double>::infinity()
                             : depths.size() < least_points ? scene.extent()
                                                            : median(depths);
        poses.push_back({c, std::max(depth, least_depth)});
    }
    follow_leaders(scene.train, poses);
    return poses;
}

std::array<float, given_width> numbers_of(const given_pose& given) {
    std::array<float, given_width> numbers{static_cast<float>(given.depth),
                                           given.leader ? static_cast<float>(*given.leader) : -1.0f};
    for (int k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(k);
        numbers[2 + at] = static_cast<float>(given.lever[k]);
        for (int row = 0; row < 3; ++row)
            numbers[5 + 3 * at + static_cast<std::size_t>(row)] =
                static_cast<float>(given.from_leader[k][row]);
    }
    return numbers;
}

given_pose from_numbers(const camera& given, std::span<const float, given_width> numbers) {
    given_pose pose{given, static_cast<double>(numbers[0])};
    if (numbers[1] >= 0) pose.leader = static_cast<std::size_t>(numbers[1]);
    for (int k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(k);
        pose.lever[k] = static_cast<double>(numbers[2 + at]);
        for (int row = 0; row < 3; ++row)
            pose.from_leader[k][row] =
                static_cast<double>(numbers[5 + 3 * at + static_cast<std::size_t>(row)]);
    }
    return pose;
}

camera moved(const given_pose& given, const pose_change& change) {
    const glm::dvec3 turn = turn_of(given, change);
    const glm::dvec3 by_lever = (glm::transpose(rotation_by(turn)) - glm::dmat3(1)) * given.lever;
    const glm::dvec3 center = given.camera.center() + glm::transpose(leader_rotation(given)) *
                                                          (shift_unit * shift_of(change) + by_lever);
    camera result = given.camera;
    result.rotation = rotation_by(given.from_leader * turn) * given.camera.rotation;
    result.translation = -(result.rotation * center);
    return result;
}

std::vector<std::optional<pose_change>> changes_to(const std::vector<std::optional<camera>>& cameras,
                                                   const std::vector<given_pose>& given) {
    const std::size_t views = given.size();
    std::vector<glm::dvec3> turns(views), shifts(views);  // by leader: first sums, then means
    std::vector<double> counts(views);
    const auto leader_of = [&](std::size_t v) { return given[v].leader.value_or(v); };
    for (std::size_t v = 0; v < views; ++v) {
        if (!cameras[v]) continue;
        const glm::dmat3 turn = cameras[v]->rotation * glm::transpose(given[v].camera.rotation);
        turns[leader_of(v)] += glm::transpose(given[v].from_leader) * rotation_vector_of(turn);
        ++counts[leader_of(v)];
    }
    for (std::size_t v = 0; v < views; ++v)
        if (counts[v] > 0) turns[v] /= counts[v];
    for (std::size_t v = 0; v < views; ++v) {
        if (!cameras[v]) continue;
        const glm::dmat3 turn = rotation_by(turns[leader_of(v)]);
        const glm::dvec3 by_lever = (glm::transpose(turn) - glm::dmat3(1)) * given[v].lever;
        const glm::dvec3 moved_by = cameras[v]->center() - given[v].camera.center();
        shifts[leader_of(v)] += leader_rotation(given[v]) * moved_by - by_lever;
    }
    std::vector<std::optional<pose_change>> changes(views);
    for (std::size_t v = 0; v < views; ++v) {
        if (counts[v] == 0) continue;
        const glm::dvec3 shift = shifts[v] / (counts[v] * shift_unit);
        const glm::dvec3 turn = turns[v] - turn_by_shift(given[v]) * shift;
        const glm::vec3 a(turn), b(shift);
        changes[v] = {a.x, a.y, a.z, b.x, b.y, b.z};
    }
    return changes;
}

pose_derivatives derivatives_of(const given_pose& given, const pose_change& change) {
    const glm::dvec3 turn = turn_of(given, change);
    const glm::dmat3 leader = leader_rotation(given), turned = rotation_by(turn) * leader,
                     by_turn = glm::transpose(left_jacobian(turn));
    return {by_turn * turned, shift_unit * leader, glm::transpose(turn_by_shift(given)),
            -by_turn * cross_product_by(given.lever) * turned};
}

void remove_common_motion(const std::vector<given_pose>& given, std::vector<float>& changes) {
    common_motion common;
    const auto value_of = [&](std::size_t view, std::size_t k) {
        return static_cast<double>(changes[view * pose_width + k]);
    };
    const auto leads = [&](std::size_t v) { return !given[v].leader; };
    for (std::size_t v = 0; v < given.size(); ++v) {
        if (!leads(v)) continue;
        const common_motion::rows rows = common_motion::rows_of(given[v]);
        for (std::size_t k = 0; k < pose_width; ++k) common.add(rows[k], value_of(v, k));
    }
    const common_motion::row fit = common.fit();
    for (std::size_t v = 0; v < given.size(); ++v) {
        if (!leads(v)) continue;
        const common_motion::rows rows = common_motion::rows_of(given[v]);
        for (std::size_t k = 0; k < pose_width; ++k)
            changes[v * pose_width + k] = static_cast<float>(
                value_of(v, k) - std::inner_product(fit.begin(), fit.end(), rows[k].begin(), 0.0));
    }
}

}  // namespace gs::features
