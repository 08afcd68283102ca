// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Made-up data, the same in every run, and sums whose float results are exact.

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace example {

inline std::mt19937& random() {
    static std::mt19937 generator(12345);
    return generator;
}

inline unsigned random_below(unsigned end) { return static_cast<unsigned>(random()() % end); }

inline std::vector<unsigned> uniform(unsigned n, unsigned end) {
    std::vector<unsigned> v(n);
    for (unsigned& i : v) i = random_below(end);
    return v;
}

/// i in [0, end) with a probability in proportion to 1 / (i + 1), as words of a language by rank.
inline std::vector<unsigned> zipf(unsigned n, unsigned end) {
    std::vector<double> below(end);
    double sum = 0;
    for (unsigned i = 0; i < end; ++i) below[i] = sum += 1.0 / (i + 1);
    std::vector<unsigned> v(n);
    for (unsigned& i : v) {
        const double at = sum * static_cast<double>(random()()) / 0x1p32;
        i = static_cast<unsigned>(std::upper_bound(below.begin(), below.end(), at) - below.begin());
    }
    return v;
}

/// Sums of floats that come out the same in whatever order they are added: each value is a multiple of
/// `unit`, and the absolute values of one sum stay within 2^24 units, so no partial sum is ever rounded.
class exact_sums {
  public:
    exact_sums(std::size_t n, double unit) : unit_(unit), sums_(n), absolute_(n) {}

    /// @throws std::logic_error if the sum would no longer be exact
    void add(std::size_t i, double value) {
        const double units = value / unit_;
        absolute_[i] += std::abs(units);
        if (units != std::floor(units) || absolute_[i] > 0x1p24)
            throw std::logic_error("the reference is not exact");
        sums_[i] += value;
    }
    std::vector<float> values() const { return {sums_.begin(), sums_.end()}; }

  private:
    double unit_;
    std::vector<double> sums_, absolute_;
};

}  // namespace example
