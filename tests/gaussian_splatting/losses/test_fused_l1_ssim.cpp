// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "losses/l1_ssim/l1_ssim.hpp"

namespace {

using gs::train::fused_l1_ssim;

/// A render and its target, both noise of any transparency. With a mask, a fifth of the pixels is masked.
template <class Real>
struct image_pair {
    int width, height;
    bool masked;
    std::vector<Real> render;
    std::vector<std::uint8_t> rgba;

    image_pair(int w, int h, bool with_mask) : width(w), height(h), masked(with_mask) {
        std::mt19937 random(17);
        const auto pixels = static_cast<std::size_t>(width * height);
        for (std::size_t i = 0; i < pixels; ++i) {
            const auto alpha = static_cast<std::uint8_t>(random() % 256);
            const bool is_out = masked && random() % 5 == 0;
            for (int c = 0; c < 3; ++c)
                rgba.push_back(is_out ? 255 : static_cast<std::uint8_t>(random() % (alpha + 1u)));
            rgba.push_back(is_out ? 0 : alpha);
        }
        for (std::size_t i = 0; i < 3 * pixels; ++i)
            render.push_back(static_cast<Real>(random() % 1000) / 999);
    }
    gs::row_range rows{};  ///< the rows that are compared
    gs::train::target_image target() const {
        return {rgba.data(), width, height, {0.25f, 1.0f, 0.5f}, masked, rows};
    }
};

template <class Real>
struct loss_result {
    std::vector<Real> gradient;
    std::vector<double> sums;
};

/// Runs a pass of `l1_ssim` over an image pair.
template <template <class, class> class Pass, class Device, class Real>
loss_result<Real> result_of(const image_pair<Real>& images, const gs::raster::list_capacity& capacity = {}) {
    Device device;
    Pass<Device, Real> pass(device);
    loss_result<Real> result{std::vector<Real>(images.render.size(), Real(7)), {}};
    pass.set_target(images.target());
    pass.run(images.render.data(), result.gradient.data(), capacity);
    result.sums.assign(pass.sums().begin(), pass.sums().end());
    return result;
}

/// The kernel on one thread with this number of rows per strip.
template <class Warp, class Real>
std::vector<Real> gradient_by_rows(const image_pair<Real>& images, int rows) {
    using kernel = fused_l1_ssim<Real, false>;
    using strip = typename kernel::template strip_of<Warp>;
    gs::device::basic_cpu<Warp> device;
    std::vector<Real> gradient(images.render.size());
    double totals[gs::train::comparison_total_count]{};
    const kernel k{reinterpret_cast<const std::uint32_t*>(images.rgba.data()),
                   images.render.data(),
                   images.width,
                   images.height,
                   {Real(0.25), Real(1), Real(0.5)},
                   gs::train::ssim_window<Real>::make(),
                   {0, images.height},
                   rows,
                   static_cast<Real>(gs::train::l1_ssim_weight),
                   gradient.data(),
                   totals,
                   {}};
    device.for_each_warp(strip::count(images.width, {0, images.height}, rows), k);
    return gradient;
}

template <class Warp>
using on_warp = gs::device::basic_cpu<Warp>;
using lanes = warpagg::emulator::lanes;
using wide_lanes = warpagg::emulator::wide_lanes;

/// Compares the fused pass with the three passes: equal bits of the gradient, totals up to their rounding.
template <class Warp, class Real>
void check_equal_to_three_passes(bool masked) {
    // A strip of 32 lanes has 54 columns, and one of 64 lanes has 118.
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 17}, {17, 1}, {33, 9}, {54, 12}, {64, 20}, {119, 31}}) {
        CAPTURE(width);
        CAPTURE(height);
        const image_pair<Real> images(width, height, masked);
        const auto expected = result_of<gs::train::three_passes, gs::device::cpu>(images);
        const auto found = result_of<gs::train::fused_pass, on_warp<Warp>>(images);
        CHECK(found.gradient == expected.gradient);
        for (std::size_t i = 0; i < found.sums.size(); ++i)
            CHECK(found.sums[i] == doctest::Approx(expected.sums[i]).epsilon(1e-6));
    }
}

}  // namespace

TEST_CASE_TEMPLATE("fused_l1_ssim: the results are those of the three passes", Real, float, double) {
    for (const bool masked : {false, true}) {
        CAPTURE(masked);
        check_equal_to_three_passes<lanes, Real>(masked);
    }
}

TEST_CASE("fused_l1_ssim: the results do not depend on the width of a warp") {
    check_equal_to_three_passes<wide_lanes, float>(true);
}

TEST_CASE("fused_l1_ssim: the gradient does not depend on the number of strips") {
    const image_pair<float> images(70, 45, false);
    const auto expected = gradient_by_rows<lanes>(images, 45);
    for (const int rows : {1, 7, 44}) {
        CAPTURE(rows);
        CHECK(gradient_by_rows<lanes>(images, rows) == expected);
    }
}

TEST_CASE_TEMPLATE("l1_ssim: the rows of several ranks have the gradient and the sums of all rows", Warp,
                   warpagg::emulator::narrow_lanes<8>, lanes) {
    constexpr int width = 60, height = 50;
    const auto result_in = [](const image_pair<float>& images) {
        if constexpr (Warp::size == 8)
            return result_of<gs::train::three_passes, on_warp<Warp>>(images);
        else
            return result_of<gs::train::fused_pass, on_warp<Warp>>(images);
    };
    const auto whole = result_in(image_pair<float>(width, height, true));
    loss_result<float> joined{std::vector<float>(whole.gradient.size()),
                              std::vector<double>(whole.sums.size())};
    for (const gs::row_range own : {gs::row_range{0, 16}, {16, 32}, {32, 32}, {32, height}}) {
        image_pair<float> images(width, height, true);
        images.rows = own;
        for (int c = 0; c < 3; ++c)  // as far away as `l1_ssim::reach` permits
            for (int row = 0; row < height; ++row)
                if (row < own.first - 10 || row >= own.last + 10)
                    std::fill_n(images.render.begin() + (c * height + row) * width, width, std::nanf(""));
        const auto part = result_in(images);
        for (std::size_t i = 0; i < part.sums.size(); ++i) joined.sums[i] += part.sums[i];
        for (int c = 0; c < 3; ++c)
            std::copy_n(part.gradient.begin() + (c * height + own.first) * width, own.count() * width,
                        joined.gradient.begin() + (c * height + own.first) * width);
    }
    CHECK(joined.gradient == whole.gradient);
    for (std::size_t i = 0; i < whole.sums.size(); ++i)
        CHECK(joined.sums[i] == doctest::Approx(whole.sums[i]).epsilon(1e-6));
}

TEST_CASE("fused_l1_ssim: a render whose tile lists did not fit does not count") {
    const std::uint64_t required = 3;
    const auto result =
        result_of<gs::train::fused_pass, on_warp<lanes>>(image_pair<float>(9, 9, false), {&required, 2});
    CHECK(result.sums == std::vector<double>(gs::train::comparison_total_count, 0.0));
}

TEST_CASE("l1_ssim: devices with wide warps use the fused pass and need no maps") {
    gs::device::basic_cpu<lanes> device;
    const std::size_t before = device.used_bytes();
    gs::train::l1_ssim<gs::device::basic_cpu<lanes>, float> loss(device);
    const image_pair<float> images(64, 64, false);
    loss.set_target(images.target());
    loss.gradient(images.render.data(), {});
    CHECK(device.used_bytes() - before == 3 * 64 * 64 * sizeof(float) + 4 * sizeof(double));
}
