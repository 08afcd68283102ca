// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "gaussian_shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gs {

namespace {

/// Returns equal parts.
std::vector<double> even_ends(std::size_t ranks) {
    std::vector<double> ends(ranks);
    for (std::size_t r = 0; r < ranks; ++r) ends[r] = static_cast<double>(r + 1) / static_cast<double>(ranks);
    return ends;
}

}  // namespace

ranks::shares gaussian_shares::of(std::size_t gaussians, int ranks) const {
    const auto count = static_cast<std::size_t>(ranks);
    if (ends_.size() != count) return {gaussians, block_length, ranks};
    const std::size_t blocks = (gaussians + block_length - 1) / block_length;
    std::vector<std::size_t> ends;
    for (const double end : ends_)
        ends.push_back(static_cast<std::size_t>(std::llround(end * static_cast<double>(blocks))));
    return {gaussians, block_length, ends};
}

void gaussian_shares::note(const ranks::shares& shown, std::size_t gaussians, int ranks) {
    const ranks::shares all = of(gaussians, ranks);
    work_.resize(static_cast<std::size_t>(ranks));
    for (int r = 0; r < ranks; ++r)
        work_[static_cast<std::size_t>(r)] += static_cast<double>(shown.of(r).count()) +
                                              work_of_hidden * static_cast<double>(all.of(r).count());
}

bool gaussian_shares::are_uneven() const {
    constexpr double tolerance = 1.05;
    const double whole = std::accumulate(work_.begin(), work_.end(), 0.0);
    return whole > 0 &&
           *std::ranges::max_element(work_) * static_cast<double>(work_.size()) > tolerance * whole;
}

void gaussian_shares::balance() {
    const double whole = std::accumulate(work_.begin(), work_.end(), 0.0);
    const std::size_t ranks = work_.size();
    if (ranks < 2 || whole == 0) return;
    const std::vector<double> before = ends_.size() == ranks ? ends_ : even_ends(ranks);
    const std::vector<double> wanted = even_ends(ranks);
    // Within a share, the work is taken to be spread evenly. Later calls correct the error.
    std::vector<double> ends;
    double begin = 0, done = 0;
    for (std::size_t r = 0; r < ranks; ++r) {
        const double sum = done + work_[r] / whole;
        while (ends.size() + 1 < ranks && wanted[ends.size()] <= sum)
            ends.push_back(begin + (before[r] - begin) * (wanted[ends.size()] - done) / (sum - done));
        begin = before[r];
        done = sum;
    }
    ends.resize(ranks, 1.0);
    ends_ = ends;
    work_.clear();
}

}  // namespace gs
