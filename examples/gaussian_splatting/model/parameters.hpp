// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <warpagg/core/compiler.hpp>

namespace gs {

/// The parameters of a Gaussian. Each has its own array in device memory. Each SH degree is a
/// separate parameter, so that unused degrees are not stored, read or updated.
enum class parameter : unsigned { mean, log_scale, quaternion, opacity, sh0, sh1, sh2, sh3, count };
inline constexpr std::size_t parameter_count = static_cast<std::size_t>(parameter::count);

/// Number of values per Gaussian, by parameter.
inline constexpr std::array<int, parameter_count> parameter_width{3, 3, 4, 1, 3, 9, 15, 21};

inline constexpr std::array<const char*, parameter_count> parameter_names{
    "mean", "log_scale", "quaternion", "opacity", "sh0", "sh1", "sh2", "sh3"};

constexpr std::size_t width_of(parameter p) {
    return static_cast<std::size_t>(parameter_width[static_cast<std::size_t>(p)]);
}
WARPAGG_HD constexpr parameter sh_band(int band) {
    return static_cast<parameter>(static_cast<int>(parameter::sh0) + band);
}
/// Returns the SH degree of a parameter that has one.
WARPAGG_HD constexpr int degree_of(parameter p) {
    return static_cast<int>(p) - static_cast<int>(parameter::sh0);
}

/// Returns whether a model of this SH degree has the parameter.
constexpr bool has_parameter(std::size_t p, int sh_degree) {
    return static_cast<int>(p) - static_cast<int>(parameter::sh0) <= sh_degree;
}

/// Returns whether the parameter belongs to SH degrees 1 to 3, which some Gaussians lack.
constexpr bool is_view_dependent(std::size_t p) { return p > static_cast<std::size_t>(parameter::sh0); }

/// Pointers to the arrays of all parameters, in AoSoA layout: see `aosoa_index`. Values, gradients
/// and moments use it.
template <class Real>
struct parameter_arrays {
    Real* mean = nullptr;
    Real* log_scale = nullptr;
    Real* quaternion = nullptr;  ///< w x y z
    Real* opacity = nullptr;     ///< logit
    Real* sh[8] = {};            ///< by SH degree: RGB of each coefficient; the cache of degree d at 4 + d
    /// The number of Gaussians with SH coefficients above degree 0, which precede all others. It is
    /// a multiple of the block length, or all. The others have the same color in all directions.
    std::size_t gaussians_with_sh = std::numeric_limits<std::size_t>::max();
    /// The slot of each block in the cache, which replaces those blocks of degrees 1 to 3 that it has: 1
    /// plus its index, or 0 if it lacks the block. Null without a cache.
    const std::uint32_t* cache_slot = nullptr;

    WARPAGG_HD constexpr Real* operator[](parameter p) const {
        switch (p) {
            case parameter::mean:
                return mean;
            case parameter::log_scale:
                return log_scale;
            case parameter::quaternion:
                return quaternion;
            case parameter::opacity:
                return opacity;
            default:
                return sh[degree_of(p)];
        }
    }
};

}  // namespace gs
