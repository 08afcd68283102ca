// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "interior_ssim.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace gs::evaluate {

namespace {

constexpr std::size_t window = 11;
constexpr double deviation = 1.5;

/// Returns the taps of the window in one direction.
std::array<double, window> make_taps() {
    std::array<double, window> taps{};
    double sum = 0;
    for (std::size_t i = 0; i < window; ++i) {
        const double distance = static_cast<double>(i) - static_cast<double>(window / 2);
        sum += taps[i] = std::exp(-distance * distance / (2 * deviation * deviation));
    }
    for (double& tap : taps) tap /= sum;
    return taps;
}

/// Weighted means of u = x + y, v = x - y and their squares, one value per column. The SSIM of x
/// and y is simplest in terms of u and v.
struct means {
    std::vector<double> u, v, uu, vv;

    explicit means(std::size_t columns) : u(columns), v(columns), uu(columns), vv(columns) {}
    void clear() {
        for (auto* values : {&u, &v, &uu, &vv}) std::ranges::fill(*values, 0.0);
    }
};

/// Adds a row of pixels, with a weight.
void add_row(means& to, double weight, const float* x, const float* y) {
    const std::size_t columns = to.u.size();
    double *const u = to.u.data(), *const v = to.v.data(), *const uu = to.uu.data(), *const vv = to.vv.data();
    for (std::size_t i = 0; i < columns; ++i) {
        const double sum = static_cast<double>(x[i]) + static_cast<double>(y[i]);
        const double difference = static_cast<double>(x[i]) - static_cast<double>(y[i]);
        const double weighted_sum = weight * sum, weighted_difference = weight * difference;
        u[i] += weighted_sum;
        v[i] += weighted_difference;
        uu[i] += weighted_sum * sum;
        vv[i] += weighted_difference * difference;
    }
}

void add_columns(std::vector<double>& to, double weight, const std::vector<double>& from, std::size_t first) {
    const double* const shifted = from.data() + first;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += weight * shifted[i];
}

/// Reduces the means over columns of the image to means over windows.
void sum_along_row(const std::array<double, window>& taps, const means& columns, means& windows) {
    windows.clear();
    for (std::size_t k = 0; k < window; ++k) {
        add_columns(windows.u, taps[k], columns.u, k);
        add_columns(windows.v, taps[k], columns.v, k);
        add_columns(windows.uu, taps[k], columns.uu, k);
        add_columns(windows.vv, taps[k], columns.vv, k);
    }
}

double ssim_of(const means& m, std::size_t i) {
    constexpr double C1 = 0.01 * 0.01, C2 = 0.03 * 0.03;
    const double mu = m.u[i] * m.u[i], mv = m.v[i] * m.v[i];
    const double vu = m.uu[i] - mu, vv = m.vv[i] - mv;
    return ((mu - mv) / 2 + C1) * ((vu - vv) / 2 + C2) / (((mu + mv) / 2 + C1) * ((vu + vv) / 2 + C2));
}

/// Tells for each window, row by row, whether it contains a masked pixel.
class masked_windows {
  public:
    explicit masked_windows(const image& photo) : has_mask_(photo.has_mask) {
        if (!has_mask_) return;
        const auto width = static_cast<std::size_t>(photo.width),
                   height = static_cast<std::size_t>(photo.height);
        columns_ = width - window + 1;
        masked_.resize((height - window + 1) * columns_);
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x)
                if (photo.is_masked(y * width + x)) mark(x, y);
    }
    bool operator()(std::size_t column, std::size_t row) const {
        return has_mask_ && masked_[row * columns_ + column] != 0;
    }

  private:
    /// Marks the windows that contain pixel (x, y).
    void mark(std::size_t x, std::size_t y) {
        const std::size_t rows = masked_.size() / columns_;
        for (std::size_t row = y < window ? 0 : y - window + 1; row < std::min(y + 1, rows); ++row)
            for (std::size_t column = x < window ? 0 : x - window + 1; column < std::min(x + 1, columns_);
                 ++column)
                masked_[row * columns_ + column] = 1;
    }

    bool has_mask_;
    std::size_t columns_ = 0;
    std::vector<std::uint8_t> masked_;
};

}  // namespace

std::optional<double> interior_ssim(const std::vector<float>& render, const std::vector<float>& target,
                                    const image& photo) {
    const auto width = static_cast<std::size_t>(photo.width), height = static_cast<std::size_t>(photo.height);
    if (std::min(width, height) < window) return std::nullopt;
    static const std::array<double, window> taps = make_taps();
    const masked_windows is_masked(photo);
    means columns(width), windows(width - window + 1);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (std::size_t y = 0; y + window <= height; ++y) {
            columns.clear();
            for (std::size_t k = 0; k < window; ++k) {
                const std::size_t row = (channel * height + y + k) * width;
                add_row(columns, taps[k], &render[row], &target[row]);
            }
            sum_along_row(taps, columns, windows);
            for (std::size_t x = 0; x + window <= width; ++x) {
                if (is_masked(x, y)) continue;
                sum += ssim_of(windows, x);
                ++count;
            }
        }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

}  // namespace gs::evaluate
