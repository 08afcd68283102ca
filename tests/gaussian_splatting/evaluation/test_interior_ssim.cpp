// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>

#include "evaluation/interior_ssim.hpp"
#include "evaluation/png_psnr.hpp"
#include "patterns.hpp"

using namespace gs_test;

namespace {

std::optional<double> ssim_of(const pattern_images& images) {
    return gs::evaluate::interior_ssim(images.render, images.target, images.photo);
}

}  // namespace

TEST_CASE("the interior SSIM is that of scikit-image") {
    const auto expected = reference_metrics("interior_ssim");
    const auto check = [&](const std::string& key, const pattern_images& images) {
        CAPTURE(key);
        REQUIRE(ssim_of(images));
        // scikit-image sums in another order.
        CHECK(*ssim_of(images) == doctest::Approx(expected.at(key).get<double>()).epsilon(1e-9));
    };
    check("37x29", make_images(37, 29));
    check("11x11", make_images(11, 11));
    check("64x48", make_images(64, 48));
    pattern_images masked = make_images(64, 48);
    mask_pattern(masked.photo);
    check("64x48 masked", masked);
}

TEST_CASE("the interior SSIM ignores the colors of masked pixels") {
    pattern_images images = make_images(64, 48);
    mask_pattern(images.photo);
    const auto before = ssim_of(images);
    for (std::size_t i = 0; i < images.render.size(); ++i)
        if (images.photo.is_masked(i % (64 * 48))) images.render[i] = 1 - images.render[i];
    CHECK(ssim_of(images) == before);
}

TEST_CASE("the interior SSIM of equal images is 1") {
    pattern_images images = make_images(16, 16);
    images.render = images.target;
    CHECK(*ssim_of(images) == doctest::Approx(1).epsilon(1e-14));
}

TEST_CASE("an image without a window of unmasked pixels has no interior SSIM") {
    CHECK_FALSE(ssim_of(make_images(10, 64)));
    CHECK_FALSE(ssim_of(make_images(64, 10)));
    pattern_images images = make_images(21, 21);
    CHECK(ssim_of(images));
    images.photo.mask_pixel(10 * 21 + 10);  // each window contains the pixel in the center
    CHECK_FALSE(ssim_of(images));
}

TEST_CASE("the PSNR of 8 bits rounds both images and ignores masked pixels") {
    gs::image photo{2, 1, std::vector<std::uint8_t>(8, 255)};
    const std::vector<float> render{100.4F / 255, 0, 0.5F, 0, 1, 0};
    const std::vector<float> target{101.4F / 255, 1, 0.5F, 1, 1, 1};
    CHECK(gs::evaluate::png_psnr(render, target, photo) ==
          doctest::Approx(-10 * std::log10((1 + 3 * 255. * 255) / 6 / (255. * 255))));
    photo.mask_pixel(1);
    CHECK(gs::evaluate::png_psnr(render, target, photo) ==
          doctest::Approx(-10 * std::log10(1. / 3 / (255. * 255))));
}
