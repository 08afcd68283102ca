// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <numeric>
#include <warpagg/core/compiler.hpp>

#include "aosoa.hpp"

namespace gs {

/// Cuts an order of Gaussians into pieces, and moves neighboring pieces far apart. Neighbors in a piece
/// stay beside each other, so that views show most of a piece or nothing. Ranks own consecutive
/// Gaussians. Each of them then owns some of the Gaussians that a view shows.
class spread_pieces {
  public:
    static constexpr std::size_t piece_length = 8 * block_length;

    explicit spread_pieces(std::size_t count) : pieces_(count / piece_length) {
        // Multiples of the golden ratio are evenly distributed modulo 1, however many there are.
        step_ = static_cast<std::size_t>(0.618 * static_cast<double>(pieces_));
        while (pieces_ > 0 && std::gcd(step_, pieces_) != 1) ++step_;
    }
    /// Returns the new place of the Gaussian at a place. The places of all Gaussians differ. Those behind
    /// the last whole piece stay.
    WARPAGG_HD std::size_t place_of(std::size_t before) const {
        const std::size_t piece = before / piece_length;
        if (piece >= pieces_) return before;
        return piece * step_ % pieces_ * piece_length + before % piece_length;
    }

  private:
    std::size_t pieces_, step_ = 0;
};

}  // namespace gs
