// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "codebook.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gs::cluster {
namespace {

constexpr std::size_t bins = 1 << 14, bins_per_cell = 64;
constexpr int iterations = 100;

struct bin {
    double sum = 0, count = 0;
    double weight = 0;  ///< in the choice of the first numbers
};

/// Returns the bins that are not empty, in ascending order. The weight is the cube root of the density
/// in a cell of several bins: numbers of this density minimize the error of fine quantization (Panter
/// and Dite 1951).
std::vector<bin> histogram_of(std::span<const float> values) {
    const auto [low, high] = std::ranges::minmax(values);
    const double scale = high > low ? (bins - 1) / (double(high) - double(low)) : 0;
    std::vector<bin> histogram(bins);
    for (const float x : values) {
        bin& b = histogram[static_cast<std::size_t>((double(x) - double(low)) * scale)];
        b.sum += double(x);
        ++b.count;
    }
    for (std::size_t first = 0; first < bins; first += bins_per_cell) {
        const std::span cell(&histogram[first], bins_per_cell);
        double count = 0, filled = 0;
        for (const bin& b : cell) {
            count += b.count;
            filled += b.count > 0;
        }
        for (bin& b : cell) b.weight = filled > 0 ? std::cbrt(count) / filled : 0;
    }
    std::erase_if(histogram, [](const bin& b) { return b.count == 0; });
    return histogram;
}

/// Returns where to begin.
std::vector<double> first_numbers(const std::vector<bin>& histogram) {
    double total = 0;
    for (const bin& b : histogram) total += b.weight;
    std::vector<double> numbers;
    double before = 0;
    for (const bin& b : histogram) {
        before += b.weight;
        const double wanted = before / total * static_cast<double>(codebook::size);
        while (static_cast<double>(numbers.size()) + 0.5 < wanted) numbers.push_back(b.sum / b.count);
    }
    numbers.resize(codebook::size, numbers.back());
    return numbers;
}

/// Moves each number to the mean of the values that are nearest to it.
void move(const std::vector<bin>& histogram, std::vector<double>& numbers) {
    std::vector<bin> nearest(numbers.size());
    std::size_t k = 0;
    for (const bin& b : histogram) {
        const double mean = b.sum / b.count;
        while (k + 1 < numbers.size() && std::abs(numbers[k + 1] - mean) < std::abs(numbers[k] - mean)) ++k;
        nearest[k].sum += b.sum;
        nearest[k].count += b.count;
    }
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (nearest[i].count > 0) numbers[i] = nearest[i].sum / nearest[i].count;
    std::ranges::sort(numbers);
}

}  // namespace

codebook::codebook(std::span<const float> values) {
    if (values.empty()) return;
    const std::vector<bin> histogram = histogram_of(values);
    std::vector<double> numbers = first_numbers(histogram);
    if (histogram.size() <= size) {  // a number for each
        for (std::size_t i = 0; i < size; ++i) {
            const bin& b = histogram[std::min(i, histogram.size() - 1)];
            numbers[i] = b.sum / b.count;
        }
    } else {
        for (int i = 0; i < iterations; ++i) move(histogram, numbers);
    }
    std::ranges::transform(numbers, values_.begin(), [](double x) { return static_cast<float>(x); });
    for (std::size_t i = 0; i + 1 < size; ++i) limits_[i] = (values_[i] + values_[i + 1]) / 2;
}

std::uint8_t codebook::nearest(float x) const {
    return static_cast<std::uint8_t>(std::ranges::lower_bound(limits_, x) - limits_.begin());
}

}  // namespace gs::cluster
