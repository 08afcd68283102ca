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
#include "../optimize/view_gradients.hpp"
#include "../render/project/project_backward.hpp"

namespace gs::train {

/// Returns the memory for `gaussians` with their tile lists, if a renderer has reserved lists for `present`
/// Gaussians: new ones are assumed to touch as many tiles. `part`: the part of the Gaussians that this rank
/// has, or one. Before the first step, views are assumed to show all of them.
template <device::device Device, class Renderer>
device::memory_forecast forecast_of_gaussians(const Renderer& renderer, std::size_t present,
                                              std::size_t gaussians, int sh_degree,
                                              const training_setup& setup, double part) {
    constexpr std::size_t of_step = sizeof(std::uint32_t), of_sort = 2 * sizeof(std::uint32_t),
                          of_distribution = sizeof(std::uint64_t),
                          of_strategy = 4 * sizeof(std::uint32_t) + sizeof(std::uint64_t);
    constexpr std::size_t beside =
        sizeof(raster::visibility) + of_step + of_sort + of_distribution + of_strategy;
    const bool is_divided = part < 1;
    const auto own = [&](std::size_t bytes) {
        return static_cast<std::size_t>(part * static_cast<double>(bytes));
    };
    const double more =
        static_cast<double>(gaussians) / static_cast<double>(std::max<std::size_t>(present, 1));
    const auto grown = [&](std::size_t now) {
        return static_cast<std::uint64_t>(more * static_cast<double>(now));
    };
    const parameter_bytes of_parameters = bytes_per_gaussian(sh_degree, setup.storage);
    const std::size_t undivided = is_divided ? undivided_bytes_per_gaussian() : 0,
                      of_render = Renderer::bytes::per_gaussian(setup.facts.gradient),
                      of_batch = setup.batch_size == 1
                                     ? 0
                                     : view_gradients<Device>::bytes_per_gaussian(sh_degree) +
                                           (setup.batch_size - 1) * of_render,
                      in_training =
                          undivided + own(of_parameters.on_device - undivided + of_render + of_batch),
                      of_gather = parameter_gather<Device>::bytes_per_gaussian(sh_degree, part),
                      of_view = value_bytes_per_gaussian(sh_degree) - undivided + of_render;
    std::uint64_t of_strips = 0;
    if (is_divided || setup.batch_size > 1) {
        const std::uint64_t known = renderer.strip_bytes(setup.facts.gradient);
        of_strips = known > 0 ? grown(known)
                              : gaussians * setup.batch_size *
                                    own(Renderer::bytes::per_sent_splat(setup.facts.gradient));
    }
    const std::size_t reserved = renderer.reserved_instances(),
                      listed = renderer.strip_places() > 0 ? renderer.strip_places() : own(reserved);
    const auto of_lists = [&](std::size_t places) { return grown(places) * Renderer::bytes::per_instance(); };
    std::uint64_t others = of_strips + gaussians * of_gather + of_lists(is_divided ? listed : reserved);
    // Between steps, a rank renders whole views. Half of the reserve is for growth.
    if (is_divided) others = std::max(others, gaussians * (of_view - own(of_view)) + of_lists(reserved / 2));
    return {.gaussians = gaussians * (beside + in_training),
            .others = others,
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
    return Renderer::bytes::per_pixel() + image_comparison<Device, float>::bytes_per_pixel() +
           3 * sizeof(float);
}

}  // namespace gs::train
