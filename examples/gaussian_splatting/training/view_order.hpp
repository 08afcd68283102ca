// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <sstream>
#include <utility>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../core/error.hpp"

namespace gs::train {

/// Saves or loads the state of a random number generator.
inline void exchange_random(state_archive& archive, std::string_view name, std::mt19937_64& random) {
    std::stringstream text;
    text << random;
    std::string state = text.str();
    archive.exchange(name, state);
    if (!(std::istringstream(state) >> random))
        throw error("the checkpoint has an invalid state of random numbers");
}

/// Returns each view once in random order, then each view again in another random order, and so on.
class view_order {
  public:
    view_order(std::size_t views, std::uint64_t seed) : order_(views), next_(views), random_(seed) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
    }
    std::size_t next() {
        if (next_ == order_.size()) {
            // Not std::shuffle, whose order differs between standard libraries.
            for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random_() % i]);
            next_ = 0;
        }
        return order_[next_++];
    }
    /// Returns the results of the next calls of `next`.
    std::vector<std::size_t> upcoming(std::size_t count) const {
        view_order copy = *this;
        std::vector<std::size_t> views(count);
        for (std::size_t& view : views) view = copy.next();
        return views;
    }
    void exchange(state_archive& archive) {
        std::vector<std::size_t> views(order_.size());
        std::iota(views.begin(), views.end(), std::size_t{0});
        archive.exchange("views", order_);
        archive.exchange("next_view", next_);
        if (next_ > order_.size() || !std::ranges::is_permutation(order_, views))
            throw error("the checkpoint has an invalid order of views");
        exchange_random(archive, "random_views", random_);
    }

  private:
    std::vector<std::size_t> order_;
    std::size_t next_;
    std::mt19937_64 random_;
};

}  // namespace gs::train
