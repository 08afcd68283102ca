// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "memory_limits.hpp"

#include <omp.h>

#include <algorithm>

#include "../core/byte_size.hpp"
#include "../core/host_memory.hpp"
#include "../photos/packed_photo.hpp"

namespace gs::cli {

namespace {

/// Returns the free device memory for this rank. Each rank has its own GPU, but not its own host.
std::uint64_t own_device_bytes(const device::profiler& device, const ranks::place& place) {
    const std::uint64_t free = device.free_device_bytes();
    return device.shares_host_memory() ? free / static_cast<std::uint64_t>(place.count_on_machine) : free;
}

}  // namespace

photos::photo_limits photo_limits(const settings& s, const device::profiler& device,
                                  const ranks::place& place) {
    // The Gaussians, and the program itself, need the remaining memory. Users may leave less for them.
    const auto share = [&](std::uint64_t bytes) { return bytes / 10 * (s.photo_memory ? 9 : 6); };
    photos::photo_limits limits;
    limits.host = share(available_host_bytes() / static_cast<std::uint64_t>(place.count_on_machine));
    const std::uint64_t free = own_device_bytes(device, place);
    limits.device = share(std::min(free, s.gpu_memory.value_or(free)));
    limits.total = device.shares_host_memory() ? limits.host : limits.host + limits.device;
    if (s.photo_memory) limits.total = *s.photo_memory;
    return limits;
}

std::uint64_t device_limit(const settings& s, const device::profiler& device, const ranks::place& place) {
    if (s.gpu_memory) return *s.gpu_memory;
    if (s.deterministic) return 0;
    return (device.used_device_bytes() + own_device_bytes(device, place)) / 10 * 9;
}

train::moment_precision precision_for(std::optional<train::moment_precision> wanted,
                                      const device::memory_forecast& with_floats, std::uint64_t limit) {
    using enum train::moment_precision;
    if (wanted) return *wanted;
    return limit > 0 && with_floats.total() > limit ? compact : full;
}

train::parameter_storage storage_for(const model_memory& model, train::moment_precision precision) {
    const auto bytes = [&](const train::parameter_storage& how) {
        return train::bytes_per_gaussian(model.sh_degree, how);
    };
    const auto fits = [&](const train::parameter_storage& how) {
        const std::uint64_t saved = model.gaussians * (bytes({}).on_device - bytes(how).on_device);
        return model.device_limit == 0 || model.forecast.total() <= model.device_limit + saved;
    };
    train::parameter_storage chosen{precision};
    while (model.host_limit > 0 && !fits(chosen) && chosen.first_degree_on_host > 1) {
        train::parameter_storage next = chosen;
        --next.first_degree_on_host;
        if (model.gaussians * bytes(next).on_host > model.host_limit) break;
        chosen = next;
    }
    return chosen;
}

std::uint64_t parameter_bytes_on_host(const device::profiler& device, const ranks::place& place) {
    return device.shares_host_memory() || place.count > 1 ? 0 : available_host_bytes() / 10 * 8;
}

load_options with_limit(load_options source, const photos::photo_limits& limits) {
    source.most_photo_bytes = photos::most_resident_bytes(limits);
    return source;
}

photos::photo_plan photo_memory(const scene& of, const photos::photo_limits& limits, std::size_t at_once) {
    if (!photos::any_is_streamed(of.train, of.test)) return {};
    constexpr int most_threads = 16;  // more need much memory, and decode faster than any step is
    const auto threads = static_cast<std::size_t>(std::min(omp_get_max_threads(), most_threads));
    return photos::plan_photos(of.train, of.test, limits, threads, at_once);
}

std::uint64_t photos_on_host(const scene& of, const photos::photo_plan& plan) {
    if (photos::any_is_streamed(of.train, of.test)) return plan.on_host();
    std::uint64_t bytes = 0;
    for (const auto* views : {&of.train, &of.test})
        for (const view& v : *views) bytes += photos::packed_bytes(v.camera, v.depths.is_there());
    return bytes;
}

std::string expected_memory(const device::memory_forecast& forecast, std::size_t most,
                            std::uint64_t photos_on_host) {
    const auto gb = [](std::uint64_t bytes) { return in_gigabytes(static_cast<double>(bytes)); };
    return "expects " + gb(forecast.total()) + " GB of device memory (" + gb(forecast.photos) + " photos, " +
           gb(forecast.gaussians) + " for up to " + std::to_string(most) + " Gaussians, " +
           gb(forecast.others) + " others), and " + gb(photos_on_host) + " GB of host memory for photos" +
           (forecast.on_host == 0 ? "" : " and " + gb(forecast.on_host) + " GB for SH coefficients");
}

}  // namespace gs::cli
