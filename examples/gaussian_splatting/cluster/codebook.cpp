// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "codebook.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <queue>
#include <vector>

#include "../core/parallel.hpp"

namespace gs::cluster {
namespace {

constexpr std::size_t most_groups = 2048;
constexpr std::size_t most_sorted = std::size_t{1} << 19;

/// Returns one of every few values, so that there are at most `most_sorted`, and the smallest and
/// the largest one. Which one differs, because values may alternate between coordinates.
std::vector<float> sample_of(std::span<const float> values) {
    if (values.size() <= most_sorted) return {values.begin(), values.end()};
    const auto [least, most] = std::ranges::minmax(values);
    std::vector<float> sample{least, most};
    for (std::size_t i = 2; i < most_sorted; ++i) {
        const std::size_t first = i * values.size() / most_sorted;
        const std::size_t end = (i + 1) * values.size() / most_sorted;
        sample.push_back(values[first + i % (end - first)]);
    }
    return sample;
}

/// A range of the sorted values.
struct value_range {
    std::size_t first, end;
    double error;  ///< sum of squared distances to the mean

    bool operator<(const value_range& other) const { return error < other.error; }
};

/// A place between sorted values: what is before it, apart from constants, and its neighbors.
struct value_bound {
    double count, sum, squares;
    float last, next;
};

/// Returns the mean of the values between two places.
double mean_between(const value_bound& first, const value_bound& end) {
    return std::clamp<double>((end.sum - first.sum) / (end.count - first.count), first.next, end.last);
}

/// Returns the sum of their squared distances to the mean.
double error_between(const value_bound& first, const value_bound& end) {
    if (first.next == end.last) return 0;
    const double sum = end.sum - first.sum;
    return std::max(0.0, end.squares - first.squares - sum * sum / (end.count - first.count));
}

/// Sorted values, or a sample of very many, with the mean and the error of each range.
class sorted_values {
  public:
    explicit sorted_values(std::span<const float> values)
        : values_(sample_of(values)), sums_(values_.size() + 1), squares_(values_.size() + 1) {
        sort_in_parallel(values_);
        // Sums start in the middle, so that outliers at the ends do not cost other ranges precision.
        const std::size_t middle = values_.size() / 2;
        for (std::size_t i = middle; i < values_.size(); ++i) add(i + 1, i, 1, values_[i]);
        for (std::size_t i = middle; i-- > 0;) add(i, i + 1, -1, values_[i]);
    }

    std::size_t size() const { return values_.size(); }

    value_range make_range(std::size_t first, std::size_t end) const {
        return {first, end, error_between(bound_at(first), bound_at(end))};
    }
    /// Returns where the upper half of a range of different values begins.
    std::size_t half(const value_range& r) const {
        const double middle = std::midpoint<double>(values_[r.first], values_[r.end - 1]);
        const auto begin = values_.begin();
        return static_cast<std::size_t>(std::upper_bound(begin + static_cast<std::ptrdiff_t>(r.first),
                                                         begin + static_cast<std::ptrdiff_t>(r.end), middle) -
                                        begin);
    }

    value_bound bound_at(std::size_t i) const {
        return {static_cast<double>(i), sums_[i], squares_[i], values_[i > 0 ? i - 1 : 0],
                values_[std::min(i, size() - 1)]};
    }

  private:
    void add(std::size_t to, std::size_t from, double sign, double x) {
        sums_[to] = sums_[from] + sign * x;
        squares_[to] = squares_[from] + sign * x * x;
    }

    std::vector<float> values_;
    std::vector<double> sums_, squares_;  ///< of the values before each, apart from a constant
};

/// Returns the ends of groups of similar values, after the beginning of the first one. Splits the group
/// with the largest error until there are enough.
std::vector<value_bound> bounds_of_groups(const sorted_values& values) {
    std::priority_queue<value_range> groups;
    groups.push(values.make_range(0, values.size()));
    while (groups.size() < most_groups && groups.top().error > 0) {
        const value_range r = groups.top();
        const std::size_t half = values.half(r);
        groups.pop();
        groups.push(values.make_range(r.first, half));
        groups.push(values.make_range(half, r.end));
    }
    std::vector<std::size_t> bounds{0};
    for (; !groups.empty(); groups.pop()) bounds.push_back(groups.top().end);
    std::ranges::sort(bounds);
    std::vector<value_bound> all;
    for (const std::size_t bound : bounds) all.push_back(values.bound_at(bound));
    return all;
}

/// Finds the partition of groups into ranges with the smallest error, by dynamic programming. With
/// more groups, the last range of the best partition never begins earlier, which bounds the search.
class best_partition {
  public:
    best_partition(const std::vector<value_bound>& bounds, std::size_t ranges)
        : bounds_(bounds), starts_(ranges) {
        const std::size_t groups = bounds.size() - 1;
        before_.assign(groups + 1, std::numeric_limits<double>::max());
        before_[0] = 0;
        for (std::vector<std::uint16_t>& starts : starts_) {
            now_.assign(groups + 1, std::numeric_limits<double>::max());
            starts.resize(groups + 1);
            search(starts, 1, groups, 0, groups - 1);
            before_.swap(now_);
        }
    }

    std::vector<double> means() const {
        std::vector<double> all;
        std::size_t end = bounds_.size() - 1;
        for (std::size_t k = starts_.size(); k-- > 0; end = starts_[k][end])
            all.push_back(mean_between(bounds_[starts_[k][end]], bounds_[end]));
        std::ranges::reverse(all);
        return all;
    }

  private:
    /// Finds the errors of the first `low` to `high` groups with one more range, which begins between
    /// `earliest` and `latest`.
    void search(std::vector<std::uint16_t>& starts, std::size_t low, std::size_t high, std::size_t earliest,
                std::size_t latest) {
        if (low > high) return;
        const std::size_t end = (low + high) / 2;
        std::size_t best = earliest;
        for (std::size_t start = earliest; start <= std::min(latest, end - 1); ++start) {
            const double error = before_[start] + error_between(bounds_[start], bounds_[end]);
            if (error < now_[end]) {
                now_[end] = error;
                best = start;
            }
        }
        starts[end] = static_cast<std::uint16_t>(best);
        search(starts, low, end - 1, earliest, best);
        search(starts, end + 1, high, best, latest);
    }

    const std::vector<value_bound>& bounds_;
    std::vector<double> before_, now_;                ///< the error of the first groups with as many ranges
    std::vector<std::vector<std::uint16_t>> starts_;  ///< where the last range begins
};

}  // namespace

codebook::codebook(std::span<const float> values) {
    if (values.empty()) return;
    const sorted_values sorted(values);
    const std::vector<value_bound> bounds = bounds_of_groups(sorted);
    const std::size_t different = std::min(size, bounds.size() - 1);
    const std::vector<double> numbers = best_partition(bounds, different).means();
    for (std::size_t i = 0; i < size; ++i)
        values_[i] = static_cast<float>(numbers[std::min(i, different - 1)]);
    for (std::size_t i = 0; i + 1 < size; ++i) limits_[i] = std::midpoint(values_[i], values_[i + 1]);
}

std::uint8_t codebook::nearest(float x) const {
    return static_cast<std::uint8_t>(std::ranges::lower_bound(limits_, x) - limits_.begin());
}

}  // namespace gs::cluster
