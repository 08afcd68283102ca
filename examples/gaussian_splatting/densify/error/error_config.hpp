// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "../timetable.hpp"

namespace gs::options {
struct option;
}

namespace gs::train {

/// Settings of the strategy `error`.
struct error_config {
    static constexpr std::string_view name = "error";

    int views = 10;       ///< number of training views that each growth compares with photos
    double level = 0.05;  ///< mean error of the three channels above which a pixel is wrong
    double pixels = 1;    ///< wrong pixels in a mean view from which a Gaussian grows

    /// A member of every strategy's settings: see `strategy_config`.
    /// @{
    std::vector<options::option> options();
    void check(const training_facts&) const {}
    error_config resolved(const training_facts&) const { return *this; }
    std::optional<std::size_t> target_count() const { return {}; }
    /// @}
};

}  // namespace gs::train
