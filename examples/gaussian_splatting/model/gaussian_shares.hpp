// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "../ranks/shares.hpp"
#include "aosoa.hpp"

namespace gs {

/// Divides the Gaussians among the ranks, so that views show about as many of each. Shares are
/// consecutive and consist of whole AoSoA blocks. They are even until `balance` has been called.
class gaussian_shares {
  public:
    /// The work for a Gaussian that a view does not show, as a part of that for one that it shows.
    static constexpr double work_of_hidden = 1.0 / 16;

    /// Returns the shares of this number of Gaussians. If it grows, all shares grow alike.
    ranks::shares of(std::size_t gaussians, int ranks) const;
    /// Adds a view that showed this many Gaussians of each rank.
    void note(const ranks::shares& shown, std::size_t gaussians, int ranks);
    /// Returns whether a rank has had clearly more work than the mean since the last `balance`.
    bool are_uneven() const;
    /// Moves the borders so that all ranks would have had about the same work in the views since the
    /// last call.
    void balance();

  private:
    std::vector<double> ends_;  ///< of the shares, as parts of all Gaussians; empty if shares are even
    std::vector<double> work_;  ///< by rank
};

}  // namespace gs
