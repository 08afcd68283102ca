// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "plane_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace gs::stereo {
namespace {

constexpr std::ptrdiff_t radius = 2;                              // of squares
constexpr float in_square = (2 * radius + 1) * (2 * radius + 1);  // pixels
constexpr float least_variance = 2.0F / 255 * 2.0F / 255;
constexpr float least_correlation = 0.7F;
/// The smallest difference of the best correlation from that of another distance.
constexpr float least_lead = 0.05F;

using plane = std::vector<float>;

/// Sums values over the square around each pixel. Sums near the border, where squares are not whole, are 0.
class square_sums {
  public:
    square_sums(std::size_t width, std::size_t height)
        : width_(static_cast<std::ptrdiff_t>(width)),
          height_(static_cast<std::ptrdiff_t>(height)),
          rows_(width * height) {}

    void compute(const plane& values, plane& sums) {
        for (std::ptrdiff_t i = radius; i < width_ * height_ - radius; ++i) {
            float sum = 0;
            for (std::ptrdiff_t k = -radius; k <= radius; ++k) sum += values[static_cast<std::size_t>(i + k)];
            rows_[static_cast<std::size_t>(i)] = sum;
        }
        sums.assign(values.size(), 0);
        for (std::ptrdiff_t y = radius; y < height_ - radius; ++y)
            for (std::ptrdiff_t x = radius; x < width_ - radius; ++x) {
                float sum = 0;
                for (std::ptrdiff_t k = -radius; k <= radius; ++k)
                    sum += rows_[static_cast<std::size_t>((y + k) * width_ + x)];
                sums[static_cast<std::size_t>(y * width_ + x)] = sum;
            }
    }

  private:
    std::ptrdiff_t width_, height_;
    plane rows_;
};

/// Another view, as the reference view sees it at a distance.
class warped_view {
  public:
    warped_view(const small_view& reference, const small_view& other)
        : reference_(reference),
          other_(other),
          origin_(other.camera.rotation * reference.camera.center() + other.camera.translation) {
        const glm::mat3 turn(other.camera.rotation);
        for (const glm::vec3& ray : reference.ray) turned_.push_back(turn * ray);
        brightness.resize(reference.pixels());
        is_seen.resize(reference.pixels());
    }

    void warp_to(float distance) {
        for (std::size_t i = 0; i < turned_.size(); ++i) {
            const glm::vec3 point = origin_ + distance * turned_[i];
            is_seen[i] = 0;
            brightness[i] = 0;
            float x, y;
            if (!place_of(point, x, y)) continue;
            sample(x - 0.5F, y - 0.5F, i);
        }
    }

    plane brightness, is_seen;

  private:
    bool place_of(const glm::vec3& point, float& x, float& y) const {
        const camera& c = other_.camera;
        if (c.lens() == lens_model::pinhole) {
            if (point.z <= 0) return false;
            x = static_cast<float>(c.fx) * point.x / point.z + static_cast<float>(c.cx);
            y = static_cast<float>(c.fy) * point.y / point.z + static_cast<float>(c.cy);
            return true;
        }
        camera here = c;
        here.rotation = glm::dmat3(1);
        here.translation = glm::dvec3(0);
        const auto seen = here.see(glm::dvec3(point));
        if (!seen) return false;
        x = static_cast<float>(seen->x);
        y = static_cast<float>(seen->y);
        return true;
    }
    void sample(float x, float y, std::size_t i) {
        const auto width = static_cast<float>(other_.width()), height = static_cast<float>(other_.height());
        if (!(x >= 0 && y >= 0 && x < width - 1 && y < height - 1)) return;
        const auto left = static_cast<std::size_t>(x), top = static_cast<std::size_t>(y);
        const float right = x - static_cast<float>(left), down = y - static_cast<float>(top);
        const std::size_t at = top * other_.width() + left, below = at + other_.width();
        const auto& from = other_.brightness;
        const auto& usable = other_.is_usable;
        brightness[i] = (1 - down) * ((1 - right) * from[at] + right * from[at + 1]) +
                        down * ((1 - right) * from[below] + right * from[below + 1]);
        is_seen[i] =
            usable[at] * usable[at + 1] * usable[below] * usable[below + 1] * reference_.is_usable[i];
    }

    const small_view &reference_, &other_;
    glm::vec3 origin_;  ///< center of the reference camera, in the space of the other one
    std::vector<glm::vec3> turned_;
};

/// Correlates squares of the reference view with squares of warped views.
class correlator {
  public:
    explicit correlator(const small_view& reference)
        : reference_(reference), sums_(reference.width(), reference.height()) {
        sums_.compute(reference.brightness, ours_);
        product_.resize(reference.pixels());
        for (std::size_t i = 0; i < product_.size(); ++i)
            product_[i] = reference.brightness[i] * reference.brightness[i];
        sums_.compute(product_, our_squares_);
    }
    /// Returns -1 where a square is not seen whole, or is too smooth.
    void correlate(const warped_view& other, plane& result) {
        sums_.compute(other.is_seen, seen_);
        sums_.compute(other.brightness, theirs_);
        for (std::size_t i = 0; i < product_.size(); ++i)
            product_[i] = other.brightness[i] * other.brightness[i];
        sums_.compute(product_, their_squares_);
        for (std::size_t i = 0; i < product_.size(); ++i)
            product_[i] = other.brightness[i] * reference_.brightness[i];
        sums_.compute(product_, products_);
        for (std::size_t i = 0; i < result.size(); ++i) {
            const float a = our_variance(i),
                        b = their_squares_[i] / in_square - square(theirs_[i] / in_square);
            const float ab = products_[i] / in_square - ours_[i] / in_square * (theirs_[i] / in_square);
            const bool is_valid = seen_[i] > in_square - 0.5F && a > least_variance && b > least_variance;
            result[i] = is_valid ? ab / std::sqrt(a * b) : -1;
        }
    }

  private:
    static float square(float x) { return x * x; }
    float our_variance(std::size_t i) const {
        return our_squares_[i] / in_square - square(ours_[i] / in_square);
    }

    const small_view& reference_;
    square_sums sums_;
    plane ours_, our_squares_, seen_, theirs_, their_squares_, products_, product_;
};

/// The best distance of each pixel so far.
struct winners {
    explicit winners(std::size_t pixels)
        : best(pixels, -1),
          before_best(pixels, -1),
          after_best(pixels, -1),
          rival(pixels, -1),
          last(pixels, -1),
          step(pixels, -10) {}

    void add(int k, const plane& scores) {
        for (std::size_t i = 0; i < scores.size(); ++i) {
            const float score = scores[i];
            if (score > best[i]) {
                if (k - step[i] > apart) rival[i] = std::max(rival[i], best[i]);
                best[i] = score;
                before_best[i] = last[i];
                after_best[i] = -1;
                step[i] = k;
            } else {
                if (k == step[i] + 1) after_best[i] = score;
                if (k - step[i] > apart) rival[i] = std::max(rival[i], score);
            }
            last[i] = score;
        }
    }
    /// Returns whether the maximum is clear, and lies between two other steps.
    bool is_certain(std::size_t i) const {
        return best[i] >= least_correlation && best[i] - rival[i] >= least_lead && before_best[i] > -1 &&
               after_best[i] > -1;
    }
    /// Returns the step of the maximum, between whole steps: the vertex of a parabola through three of them.
    double exact_step(std::size_t i) const {
        const double a = before_best[i], b = best[i], c = after_best[i], bend = a - 2 * b + c;
        return step[i] + (bend < 0 ? 0.5 * (a - c) / bend : 0);
    }

    static constexpr int apart = 3;  ///< steps between a maximum and its rivals
    plane best, before_best, after_best, rival, last;
    std::vector<int> step;
};

}  // namespace

std::vector<float> sweep(const small_view& reference, const std::vector<const small_view*>& others,
                         const sweep_range& range) {
    std::vector<warped_view> warped;
    for (const small_view* other : others) warped.emplace_back(reference, *other);
    correlator compare(reference);
    winners found(reference.pixels());
    plane correlation(reference.pixels()), first(reference.pixels()), second(reference.pixels());
    for (int k = 0; k < range.steps; ++k) {
        std::ranges::fill(first, -1.0F);
        std::ranges::fill(second, -1.0F);
        for (warped_view& other : warped) {
            other.warp_to(static_cast<float>(1 / range.at(k)));
            compare.correlate(other, correlation);
            for (std::size_t i = 0; i < correlation.size(); ++i) {
                second[i] = std::max(second[i], std::min(first[i], correlation[i]));
                first[i] = std::max(first[i], correlation[i]);
            }
        }
        if (warped.size() > 1)
            for (std::size_t i = 0; i < first.size(); ++i) first[i] = (first[i] + second[i]) / 2;
        found.add(k, first);
    }
    std::vector<float> inverse(reference.pixels(), 0.0F);
    for (std::size_t i = 0; i < inverse.size(); ++i)
        if (found.is_certain(i)) inverse[i] = static_cast<float>(range.at(found.exact_step(i)));
    return inverse;
}

}  // namespace gs::stereo
