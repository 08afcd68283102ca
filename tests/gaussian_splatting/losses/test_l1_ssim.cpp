// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "losses/l1_ssim/l1_ssim.hpp"

namespace {

/// The SSIM from its definition (Wang et al. 2004): a full two-dimensional window, in double. Shares no code
/// with the kernels.
double ssim_by_definition(const std::vector<double>& x, const std::vector<double>& y, int width, int height) {
    double window[11][11], sum = 0;
    for (int i = 0; i < 11; ++i)
        for (int j = 0; j < 11; ++j)
            sum += window[i][j] = std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
    double total = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < height; ++r)
            for (int q = 0; q < width; ++q) {
                double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
                for (int i = 0; i < 11; ++i)
                    for (int j = 0; j < 11; ++j) {
                        const int row = r + i - 5, column = q + j - 5;
                        if (row < 0 || row >= height || column < 0 || column >= width) continue;
                        const auto at = static_cast<std::size_t>((c * height + row) * width + column);
                        const double w = window[i][j] / sum;
                        mx += w * x[at];
                        my += w * y[at];
                        xx += w * x[at] * x[at];
                        yy += w * y[at] * y[at];
                        xy += w * x[at] * y[at];
                    }
                total += (2 * mx * my + 1e-4) * (2 * (xy - mx * my) + 9e-4) /
                         ((mx * mx + my * my + 1e-4) * (xx - mx * mx + yy - my * my + 9e-4));
            }
    return total / (3 * width * height);
}

}  // namespace

TEST_CASE("image_comparison: matches the definitions, at odd sizes, with one object for all") {
    std::mt19937 random(3);
    gs::device::cpu device;
    gs::train::image_comparison<gs::device::cpu, float> comparison(device);
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 17}, {17, 1}, {33, 9}, {64, 20}, {40, 31}}) {
        CAPTURE(width);
        CAPTURE(height);
        const auto pixels = static_cast<std::size_t>(width * height);
        std::vector<std::uint8_t> rgba(4 * pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            rgba[4 * i + 3] = static_cast<std::uint8_t>(random() % 256);
            for (std::size_t c = 0; c < 3; ++c)
                rgba[4 * i + c] = static_cast<std::uint8_t>(random() % (rgba[4 * i + 3] + 1u));
        }
        const std::array<float, 3> background{0.25f, 1.0f, 0.5f};
        std::vector<float> render(3 * pixels);
        for (float& x : render) x = static_cast<float>(random() % 1000) / 999;

        std::vector<double> x(render.begin(), render.end()), y(3 * pixels);
        double absolute = 0, square = 0;
        for (std::size_t i = 0; i < y.size(); ++i) {
            const std::size_t c = i / pixels, at = i % pixels;
            const double transparency = 1 - rgba[4 * at + 3] / 255.0;
            y[i] = rgba[4 * at + c] / 255.0 + transparency * static_cast<double>(background[c]);
            absolute += std::abs(x[i] - y[i]) / static_cast<double>(y.size());
            square += (x[i] - y[i]) * (x[i] - y[i]) / static_cast<double>(y.size());
        }

        comparison.set_target({rgba.data(), width, height, background});
        comparison.compare(render.data());
        const gs::train::image_quality q = comparison.take();
        CHECK(q.absolute_error == doctest::Approx(absolute).epsilon(1e-5));
        CHECK(q.square_error == doctest::Approx(square).epsilon(1e-5));
        CHECK(q.psnr() == doctest::Approx(-10 * std::log10(square)).epsilon(1e-5));
        CHECK(q.ssim == doctest::Approx(ssim_by_definition(x, y, width, height)).epsilon(1e-4));
    }
}

TEST_CASE("l1_ssim: the result does not depend on the number of strips") {
    constexpr int width = 45, height = 70;
    std::mt19937 random(5);
    std::vector<std::uint8_t> rgba(4 * width * height, 255);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) rgba[i] = static_cast<std::uint8_t>(random() % 256);
    std::vector<float> render(3 * width * height);
    for (float& x : render) x = static_cast<float>(random() % 1000) / 999;
    const auto compare = [&](int threads) {
        gs::device::cpu device;
        gs::train::image_comparison<gs::device::cpu, float> comparison(device);
        gs::train::l1_ssim<gs::device::cpu, float> loss(device);
        const gs::train::target_image target{rgba.data(), width, height};
        const int before = omp_get_max_threads();
        omp_set_num_threads(threads);
        comparison.set_target(target);
        comparison.compare(render.data());
        loss.set_target(target);
        const float* gradient = loss.gradient(render.data(), {});
        omp_set_num_threads(before);
        return std::pair(std::vector<float>(gradient, gradient + render.size()), comparison.take());
    };
    REQUIRE(gs::train::ssim_strip<gs::device::cpu::warp>::rows_for(width, height, 4) == height);
    REQUIRE(gs::train::ssim_strip<gs::device::cpu::warp>::rows_for(width, height, 64) < height / 2);
    const auto [gradient, all] = compare(1);
    const auto [by_strips, parts] = compare(16);
    CHECK(gradient == by_strips);
    CHECK(all.absolute_error == doctest::Approx(parts.absolute_error).epsilon(1e-6));
    CHECK(all.square_error == doctest::Approx(parts.square_error).epsilon(1e-6));
    CHECK(all.ssim == doctest::Approx(parts.ssim).epsilon(1e-6));
}

TEST_CASE("l1_ssim: masked pixels have no gradient and do not count") {
    constexpr int width = 37, height = 26;
    constexpr std::size_t pixels = width * height;
    std::mt19937 random(7);
    std::vector<std::uint8_t> rgba(4 * pixels, 255);
    std::vector<float> render(3 * pixels);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) rgba[i] = static_cast<std::uint8_t>(random() % 256);
    for (float& x : render) x = static_cast<float>(random() % 1000) / 999;
    // The reference: both images are black where the mask excludes pixels.
    std::vector<std::uint8_t> masked = rgba, black = rgba;
    std::vector<float> blackened = render;
    std::size_t kept = 0;
    const auto is_out = [](std::size_t i) { return i % width < 9 || i / width == 20 || i == 40; };
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!is_out(i)) {
            ++kept;
            continue;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            masked[4 * i + c] = 255;
            black[4 * i + c] = 0;
            blackened[c * pixels + i] = 0;
        }
        masked[4 * i + 3] = 0;
    }
    gs::device::cpu device;
    gs::train::image_comparison<gs::device::cpu, float> comparison(device);
    gs::train::l1_ssim<gs::device::cpu, float> loss(device);
    const auto compare = [&](const std::vector<std::uint8_t>& photo, const std::vector<float>& from,
                             bool mask) {
        const gs::train::target_image target{photo.data(), width, height, {}, mask};
        comparison.set_target(target);
        comparison.compare(from.data());
        loss.set_target(target);
        const float* gradient = loss.gradient(from.data(), {});
        return std::pair(std::vector<float>(gradient, gradient + from.size()), comparison.take());
    };
    const auto [expected, all] = compare(black, blackened, false);
    const auto [gradient, counted] = compare(masked, render, true);
    for (std::size_t i = 0; i < gradient.size(); ++i)
        CHECK(gradient[i] == (is_out(i % pixels) ? 0.0f : expected[i]));
    const double share = static_cast<double>(kept) / pixels;
    CHECK(counted.absolute_error == doctest::Approx(all.absolute_error / share).epsilon(1e-6));
    CHECK(counted.square_error == doctest::Approx(all.square_error / share).epsilon(1e-6));
    CHECK(counted.ssim < 0.5);  // two images of noise; equal black pixels would have a similarity of 1
    CHECK(counted.ssim < all.ssim);
}

TEST_CASE_TEMPLATE("l1_ssim: zero for equal images", Real, float, double) {
    gs::device::cpu device;
    gs::train::l1_ssim<gs::device::cpu, Real> loss(device);
    std::vector<std::uint8_t> rgba(4 * 20 * 20, 255);
    for (std::size_t i = 0; i < rgba.size(); i += 4) rgba[i] = static_cast<std::uint8_t>(i / 4);
    rgba[3] = rgba[2] = rgba[1] = 0;  // one pixel shows the background
    loss.set_target({rgba.data(), 20, 20, {0.1f, 0.2f, 0.3f}});
    std::vector<Real> render(3 * 400);
    for (std::size_t i = 0; i < 400; ++i)
        for (std::size_t c = 0; c < 3; ++c) render[c * 400 + i] = static_cast<Real>(rgba[4 * i + c]) / 255;
    for (std::size_t c = 0; c < 3; ++c) render[c * 400] = static_cast<Real>(std::array{0.1f, 0.2f, 0.3f}[c]);
    const Real* gradient = loss.gradient(render.data(), {});
    for (std::size_t i = 0; i < render.size(); ++i) CHECK(gradient[i] == 0);
    const gs::train::loss_report mean = loss.take();
    CHECK(mean.loss == doctest::Approx(0).epsilon(1e-6));
    CHECK(mean.square_error == 0);
}
