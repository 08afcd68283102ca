// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "../densify/parameter_gather.hpp"
#include "../device/memory_forecast.hpp"
#include "../engine/training_setup.hpp"
#include "../metrics/image_comparison.hpp"
#include "../render/project/project_backward.hpp"

namespace gs::train {

/// Returns the memory of one of several ranks for `gaussians` with their tile lists, if a renderer has
/// reserved lists for `present` Gaussians: new ones are assumed to touch as many tiles.
template <device::device Device, class Renderer>
device::memory_forecast forecast_of_gaussians(const Renderer& renderer, std::size_t present,
                                              std::size_t gaussians, int sh_degree,
                                              const training_setup& setup, int ranks) {
    const auto parts = static_cast<std::size_t>(ranks);
    constexpr std::size_t of_step = sizeof(std::uint32_t), of_sort = 2 * sizeof(std::uint32_t),
                          of_distribution = sizeof(std::uint64_t),
                          of_strategy = 4 * sizeof(std::uint32_t) + sizeof(std::uint64_t);
    constexpr std::size_t of_all_ranks =
        sizeof(raster::visibility) + of_step + of_sort + of_distribution + of_strategy;
    const parameter_bytes of_parameters = bytes_per_gaussian(sh_degree, setup.storage);
    const std::size_t undivided = ranks > 1 ? undivided_bytes_per_gaussian() : 0,
                      divided = of_parameters.on_device - undivided +
                                Renderer::bytes_per_gaussian(setup.facts.gradient);
    const std::size_t each = of_all_ranks + undivided + divided / parts +
                             parameter_gather<Device>::bytes_per_gaussian(sh_degree, parts);
    const double more =
        static_cast<double>(gaussians) / static_cast<double>(std::max<std::size_t>(present, 1));
    const auto grown = [&](std::size_t now) {
        return static_cast<std::uint64_t>(more * static_cast<double>(now));
    };
    return {.gaussians = gaussians * each + grown(renderer.visible().bytes()),
            .others = grown(renderer.reserved_instances()) * Renderer::bytes_per_instance(),
            .on_host = gaussians * of_parameters.on_host};
}

/// Returns the largest number of Gaussians for which a limit of device memory suffices. `forecast(n)` returns
/// the memory of n Gaussians, and `used` is the memory in use for `present` ones.
template <class Forecast>
std::uint64_t growth_limit(std::size_t present, std::uint64_t limit, std::uint64_t used,
                           const Forecast& forecast) {
    if (limit == 0) return std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t now = forecast(present), in_use = std::max(used, now);
    const std::uint64_t one = (forecast(2 * present) - now) / std::max<std::size_t>(present, 1);
    return in_use >= limit ? present : present + (limit - in_use) / std::max<std::uint64_t>(one, 1);
}

/// Returns the memory for each pixel of the largest view: its render, and the comparison with its photo.
template <device::device Device, class Renderer>
constexpr std::size_t bytes_per_pixel() {
    return Renderer::bytes_per_pixel() + image_comparison<Device, float>::bytes_per_pixel() +
           3 * sizeof(float);
}

}  // namespace gs::train
