// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <warpagg/core/compiler.hpp>

namespace gs {

/// The rows [first, last) of an image; by default all of them.
struct row_range {
    int first = 0, last = std::numeric_limits<int>::max();

    int count() const { return last - first; }
    bool operator==(const row_range&) const = default;

    /// Returns the rows that an image of this height has.
    row_range within(int height) const { return {std::min(first, height), std::min(last, height)}; }
    /// Returns these rows and `rows` more on each side, as far as an image of this height has them.
    /// No rows stay no rows.
    WARPAGG_HD row_range grown(int rows, int height) const {
        if (first >= last) return *this;
        return {first > rows ? first - rows : 0, last < height - rows ? last + rows : height};
    }
};

}  // namespace gs
