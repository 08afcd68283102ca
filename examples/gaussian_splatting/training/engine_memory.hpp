// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../densify/parameter_gather.hpp"
#include "../device/memory_forecast.hpp"
#include "../engine/training_setup.hpp"
#include "../metrics/image_comparison.hpp"
#include "../render/project/project_backward.hpp"

namespace gs::train {

/// Returns the memory of `gaussians` with their tile lists, if a renderer has reserved lists for `present`
/// Gaussians: new ones are assumed to touch as many tiles.
template <device::device Device, class Renderer>
device::memory_forecast forecast_of_gaussians(const Renderer& renderer, std::size_t present,
                                              std::size_t gaussians, int sh_degree,
                                              const training_setup& setup) {
    constexpr std::size_t of_step = sizeof(std::uint32_t), of_sort = 2 * sizeof(std::uint32_t),
                          of_distribution = sizeof(std::uint64_t),
                          of_strategy = 4 * sizeof(std::uint32_t) + sizeof(std::uint64_t);
    const std::size_t beside_parameters = sizeof(raster::visibility) +
                                          Renderer::bytes_per_gaussian(setup.facts.gradient) +
                                          parameter_gather<Device>::bytes_per_gaussian(sh_degree) + of_step +
                                          of_sort + of_distribution + of_strategy;
    const parameter_bytes of_parameters = bytes_per_gaussian(sh_degree, setup.storage);
    const double instances_per_gaussian = static_cast<double>(renderer.reserved_instances()) /
                                          static_cast<double>(std::max<std::size_t>(present, 1));
    const auto instances =
        static_cast<std::uint64_t>(instances_per_gaussian * static_cast<double>(gaussians));
    return {.gaussians = gaussians * (of_parameters.on_device + beside_parameters),
            .others = instances * Renderer::bytes_per_instance(),
            .on_host = gaussians * of_parameters.on_host};
}

/// Returns the memory for each pixel of the largest view: its render, and the comparison with its photo.
template <device::device Device, class Renderer>
constexpr std::size_t bytes_per_pixel() {
    return Renderer::bytes_per_pixel() + image_comparison<Device, float>::bytes_per_pixel() +
           3 * sizeof(float);
}

}  // namespace gs::train
