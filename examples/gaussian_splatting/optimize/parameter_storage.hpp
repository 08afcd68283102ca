// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../model/parameters.hpp"
#include "moment_precision.hpp"

namespace gs::train {

/// How the parameters of the Gaussians and Adam's moments are stored.
struct parameter_storage {
    moment_precision precision = moment_precision::full;
    /// The SH coefficients of this degree and above, with their moments, lie in host memory. From 1 to 4;
    /// 4 means none. The place does not change results.
    int first_degree_on_host = 4;

    bool operator==(const parameter_storage&) const = default;
};

/// The device has a cache with a slot for one in this number of blocks: see `block_cache`.
inline constexpr std::size_t blocks_per_slot = 8;

/// The memory of a Gaussian's parameters, with their moments, in bytes.
struct parameter_bytes {
    std::size_t on_device = 0, on_host = 0;
};

/// Returns the memory of a Gaussian of an SH degree, with its share of the cache, and without the step
/// that updated it last.
constexpr parameter_bytes bytes_per_gaussian(int sh_degree, const parameter_storage& how) {
    parameter_bytes bytes;
    std::size_t view_dependent = 0;
    for (std::size_t p = 0; p < parameter_count; ++p) {
        if (!has_parameter(p, sh_degree)) continue;
        const int values = parameter_width[p];
        const int moments = how.precision == moment_precision::full ? 2 * values : packed_width[p];
        const bool is_on_host = is_view_dependent(p) && !has_parameter(p, how.first_degree_on_host - 1);
        const std::size_t all = static_cast<std::size_t>(values + moments) * sizeof(float);
        (is_on_host ? bytes.on_host : bytes.on_device) += all;
        if (is_view_dependent(p)) view_dependent += all;
    }
    if (bytes.on_host > 0) bytes.on_device += (view_dependent + blocks_per_slot - 1) / blocks_per_slot;
    return bytes;
}

/// Returns the memory of a Gaussian's values, without moments.
constexpr std::size_t value_bytes_per_gaussian(int sh_degree) {
    std::size_t bytes = 0;
    for (std::size_t p = 0; p < parameter_count; ++p)
        if (has_parameter(p, sh_degree)) bytes += width_of(static_cast<parameter>(p)) * sizeof(float);
    return bytes;
}

/// Returns the memory of a Gaussian's values that ranks do not divide: see `divided_arrays`.
constexpr std::size_t undivided_bytes_per_gaussian() { return value_bytes_per_gaussian(0); }

}  // namespace gs::train
