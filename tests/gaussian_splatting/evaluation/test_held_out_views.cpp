// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>

#include "../training/engines.hpp"
#include "evaluation/held_out_views.hpp"
#include "patterns.hpp"
#include "training/initialize.hpp"

using namespace gs_test;
using gs::evaluate::held_out_report;

namespace {

/// A scene with two held-out views of 32x32 pixels.
gs::scene two_views() {
    gs::scene scene = small_scene("synthetic:spheres", 32);
    scene.test.resize(2);
    return scene;
}

held_out_report measure(const gs::scene& scene, const gs::evaluate::held_out_options& options = {}) {
    const auto engine = gs::train::make_cpu_engine();
    engine->set_views(scene.train, scene.test);
    engine->set_model(gs::from_points(scene.points, 0, 1000, 1));
    return gs::evaluate::measure_held_out_views(*engine, scene, {0, 0, 0}, options);
}

}  // namespace

TEST_CASE("held-out views have an interior SSIM and a PSNR of 8 bits close to the usual ones") {
    const held_out_report report = measure(two_views());
    REQUIRE(report.views.size() == 2);
    for (const auto& view : report.views) {
        CHECK(*view.psnr_8bit != view.quality.psnr());
        CHECK(*view.psnr_8bit == doctest::Approx(view.quality.psnr()).epsilon(0.01));
        CHECK(*view.ssim_interior != view.quality.ssim);
        CHECK(*view.ssim_interior == doctest::Approx(view.quality.ssim).epsilon(0.5));
        CHECK_FALSE(view.lpips);
        CHECK_FALSE(view.fitted_psnr);
    }
    CHECK(*report.mean_of("psnr_8bit") == (*report.views[0].psnr_8bit + *report.views[1].psnr_8bit) / 2);
    CHECK_FALSE(report.lpips_black);
}

TEST_CASE("masked pixels do not count in any measure of a held-out view") {
    const temporary_folder folder;
    write_lpips_weights(folder / "weights", "0,1");
    const gs::evaluate::lpips_network network(folder / "weights");
    gs::scene scene = two_views();
    const held_out_report unmasked = measure(scene, {.network = &network});
    CHECK(unmasked.lpips_black == 0);
    CHECK(*unmasked.views[0].lpips > 0);
    for (std::size_t pixel = 0; pixel < 32 * 32; ++pixel) {
        if (pixel % 32 < 20) scene.test[0].pixels.mask_pixel(pixel);
        scene.test[1].pixels.mask_pixel(pixel);
    }
    const held_out_report report = measure(scene, {.network = &network});
    CHECK(*report.views[0].lpips < *unmasked.views[0].lpips);
    CHECK(*report.views[0].lpips > 0);
    CHECK(*report.views[0].ssim_interior != *unmasked.views[0].ssim_interior);
    CHECK(*report.views[0].psnr_8bit == doctest::Approx(report.views[0].quality.psnr()).epsilon(0.01));
    // Nothing of the second view is left.
    CHECK(report.views[1].lpips == 0.0);
    CHECK_FALSE(report.views[1].ssim_interior);
    CHECK(std::isnan(*report.views[1].psnr_8bit));
    CHECK(report.mean_of("ssim_interior") == report.views[0].ssim_interior);
}
