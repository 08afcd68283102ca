// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../core/random.hpp"
#include "../../device/atomic.hpp"
#include "../../model/aosoa.hpp"
#include "../../model/opacity.hpp"
#include "../../render/geometry/list_capacity.hpp"
#include "../../render/project/geometry.hpp"
#include "../parameter_gather.hpp"
#include "mcmc_config.hpp"
#include "relocation.hpp"

namespace gs::train {

/// Finds the dead Gaussians, and weighs the others by opacity. One index per Gaussian.
struct weigh_by_opacity {
    const float* opacity;   ///< logits
    std::uint32_t* dead;    ///< 1 or 0
    std::uint32_t* weight;  ///< opacity in units of 2^-20; 0 if dead
    std::uint32_t* drawn;   ///< number of copies; set to 0

    WARPAGG_HD void operator()(std::size_t i) const {
        const float o = sigmoid(opacity[i]);
        const bool alive = o > dead_opacity;  // false for NaN
        dead[i] = alive ? 0 : 1;
        weight[i] = alive ? static_cast<std::uint32_t>(o * 0x1p20f) : 0;
        drawn[i] = 0;
    }
};

/// Draws an origin for each dead and each new Gaussian, with probabilities proportional to opacity.
/// The other Gaussians stay. One index per Gaussian of the new generation.
struct draw_origins {
    std::size_t count;  ///< number of old Gaussians
    const std::uint32_t* dead;
    const std::uint64_t* weight_before;  ///< count + 1 prefix sums; the last is the total
    std::uint64_t seed, step;
    std::uint32_t* drawn;  ///< number of copies of each old Gaussian
    std::uint32_t* origin;
    birth* births;

    WARPAGG_HD void operator()(std::size_t i) const {
        const bool stays = i < count && dead[i] == 0;
        const std::uint32_t from = stays ? static_cast<std::uint32_t>(i) : draw(i);
        if (!stays) device::atomic_add(&drawn[from], 1u);
        origin[i] = from;
        births[i] = stays ? birth::kept : birth::copy;
    }

  private:
    WARPAGG_HD std::uint32_t draw(std::size_t i) const {
        const std::uint64_t at = counter_random(seed, step, i).below(weight_before[count]);
        // Finds the Gaussian whose range of cumulated weights contains `at`.
        std::size_t low = 0, high = count;
        while (high - low > 1) {
            const std::size_t middle = low + (high - low) / 2;
            (weight_before[middle] <= at ? low : high) = middle;
        }
        return static_cast<std::uint32_t>(low);
    }
};

/// Clears the moments of Gaussians that have copies. One index per old Gaussian.
struct forget_moments {
    const std::uint32_t* drawn;
    birth* births;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (drawn[i] > 0) births[i] = birth::copy;
    }
};

/// Gives a Gaussian and its copies the opacity and scale with which they together look like the
/// Gaussian. One index per Gaussian of the new generation.
struct share_appearance {
    const std::uint32_t* origin;
    const std::uint32_t* drawn;
    parameter_arrays<float> gaussians;

    WARPAGG_HD void operator()(std::size_t index) const {
        const std::uint32_t copies = drawn[origin[index]] + 1;
        if (copies == 1) return;
        const auto i = static_cast<unsigned>(index);
        constexpr double most = 1 - 0x1p-24;
        const double opacity = warpagg::math::min(sigmoid(static_cast<double>(gaussians.opacity[i])), most);
        const relocated each = relocate(opacity, copies);
        // A copy that is born dead would be moved again in the next run.
        const double q = warpagg::math::max(each.opacity, 1.1 * static_cast<double>(dead_opacity));
        gaussians.opacity[i] = static_cast<float>(glm::log(q / (1 - q)));
        const glm::vec3 log_scale = raster::load3(gaussians.log_scale, i);
        raster::store3(gaussians.log_scale, i,
                       log_scale + glm::vec3(static_cast<float>(glm::log(each.scale))));
    }
};

/// Adds noise to the positions of transparent Gaussians. The noise has the shape of the Gaussian and
/// fades as its opacity rises (Kheradmand et al. 2024, equation 8). One index per Gaussian.
struct add_noise {
    parameter_arrays<float> values;
    float strength;  ///< the strength times the learning rate of positions
    std::uint64_t seed, step;
    raster::list_capacity capacity;

    WARPAGG_HD void operator()(std::size_t index) const {
        if (capacity.exceeded()) return;
        const auto i = static_cast<unsigned>(index);
        const float fade = sigmoid(100 * (0.005f - sigmoid(values.opacity[i])));
        if (!(fade > 1e-6f)) return;
        const glm::vec3 mean = raster::load3(values.mean, i);
        const raster::unit turn(raster::load4(values.quaternion, i));
        const glm::mat3 rotation = raster::rotation_of(turn.direction);
        const glm::vec3 variance = glm::exp(2.0f * raster::load3(values.log_scale, i));
        const glm::vec3 normal = counter_random(seed, step, i).normal3();
        const glm::vec3 moved = mean + strength * fade * (rotation * (variance * (normal * rotation)));
        if (raster::is_finite(moved)) raster::store3(values.mean, i, moved);
    }
};

}  // namespace gs::train
