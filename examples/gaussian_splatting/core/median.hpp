// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace gs {

/// Returns the quantile of the values below which the given share lies, and zero if `values` is
/// empty. Reorders the values. Precondition: 0 <= share < 1.
inline double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    const auto there =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), there, values.end());
    return *there;
}
inline double median(std::vector<double>& values) { return quantile(values, 0.5); }

}  // namespace gs
