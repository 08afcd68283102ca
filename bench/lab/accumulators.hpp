// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "render/gradients/accumulator.hpp"

/// All variants of the backward blending: the two that the trainer ships, and those of the lab.
namespace gs::lab {

/// See accumulator_set.hpp for the kernels, which have these numbers.
/// @{
inline constexpr auto native = accumulator::native;
inline constexpr auto fixed = accumulator::fixed;
inline constexpr accumulator per_lane{2};
inline constexpr accumulator reduce{3};
inline constexpr accumulator reduce_skip{4};
inline constexpr accumulator scatter{5};
inline constexpr accumulator f64{6};
inline constexpr accumulator compensated{7};
inline constexpr accumulator binned{8};
inline constexpr accumulator exact{9};
/// @}

struct named_accumulator {
    std::string_view name;
    accumulator value;
};

/// From the original kernel to the trainer's default: each rung changes one thing.
inline constexpr std::array<named_accumulator, 5> ladder{{{"per-lane", per_lane},
                                                          {"reduce", reduce},
                                                          {"reduce-skip", reduce_skip},
                                                          {"scatter", scatter},
                                                          {"split", native}}};

/// The accumulators that memory can keep the default's sums in.
inline constexpr std::array<named_accumulator, 6> accumulations{{{"native", native},
                                                                 {"f64", f64},
                                                                 {"compensated", compensated},
                                                                 {"fixed", fixed},
                                                                 {"binned", binned},
                                                                 {"exact", exact}}};

/// The ladder, and then the other accumulations of its last rung.
inline constexpr auto variants = [] {
    std::array<named_accumulator, ladder.size() + accumulations.size() - 1> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = i < ladder.size() ? ladder[i] : accumulations[i - ladder.size() + 1];
    return all;
}();

/// The name among `variants`.
constexpr std::string_view name_of(accumulator a) {
    for (const named_accumulator& v : variants)
        if (v.value == a) return v.name;
    return "unknown";
}

}  // namespace gs::lab
