// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "problem.hpp"

/// The ways of keeping sums that are measured, and their names.
enum class way { native, f64, compensated, fixed, binned2, binned3, exact, ordered };
inline constexpr std::array<std::string_view, 8> way_names{
    "native", "f64", "compensated", "fixed, scaled to fit", "binned<2>", "binned<3>", "exact", "ordered"};

/// The accumulator of `way::fixed` for values up to `largest`.
using fixed_way = warpagg::accumulate::fixed<20>;

/// Adds up problems on a device.
class adder {
  public:
    virtual ~adder() = default;
    virtual std::string device() const = 0;
    /// Returns the number of lanes of a warp.
    virtual unsigned lanes() const = 0;
    /// Returns the sums of the last `put`'s values.
    virtual std::vector<float> add_up(way how) = 0;
    /// Returns the nanoseconds of the last `add_up`, without zeroing and reading the sums.
    virtual double nanoseconds() const = 0;
    virtual void put(const problem& p) = 0;
};

std::unique_ptr<adder> make_cpu_adder();
std::unique_ptr<adder> make_cuda_adder();
