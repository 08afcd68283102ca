// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "held_out_views.hpp"

#include <omp.h>

#include <algorithm>
#include <set>

#include "../core/parallel.hpp"
#include "fit_exposure.hpp"

namespace gs::evaluate {

namespace {

template <class Measure>
double mean(const std::vector<view_quality>& views, Measure measure) {
    double sum = 0;
    for (const view_quality& v : views) sum += measure(v);
    return sum / static_cast<double>(views.size());
}

}  // namespace

std::vector<std::string> render_names(const std::vector<view>& views) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const view& v : views) {
        std::string flat = v.name;
        std::ranges::replace(flat, '/', '_');
        std::string name = std::filesystem::path(flat).replace_extension(".png").string();
        for (int again = 2; !taken.insert(name).second; ++again)
            name = flat + "_" + std::to_string(again) + ".png";
        names.push_back(name);
    }
    return names;
}

double held_out_report::psnr() const {
    return mean(views, [](const view_quality& v) { return v.quality.psnr(); });
}
double held_out_report::ssim() const {
    return mean(views, [](const view_quality& v) { return v.quality.ssim; });
}
std::optional<double> held_out_report::fitted_psnr() const {
    std::vector<view_quality> fitted = views;
    std::erase_if(fitted, [](const view_quality& v) { return !v.fitted_psnr; });
    if (fitted.empty()) return {};
    return mean(fitted, [](const view_quality& v) { return *v.fitted_psnr; });
}

held_out_report measure_held_out_views(train::engine& engine, const scene& scene,
                                       const std::array<float, 3>& background,
                                       const std::filesystem::path& folder, bool fits) {
    held_out_report report;
    const bool keeps = !folder.empty();
    if (keeps) {
        std::filesystem::create_directories(folder / "renders");
        std::filesystem::create_directories(folder / "gt");
    }
    const auto names = render_names(scene.test);
    // Each thread compresses one PNG at a time, because compression takes longer than rendering.
    std::vector<std::vector<float>> renders(static_cast<std::size_t>(omp_get_max_threads()));
    for (std::size_t first = 0; first < scene.test.size(); first += renders.size()) {
        const std::size_t count = std::min(renders.size(), scene.test.size() - first);
        for (std::size_t i = 0; i < count; ++i)
            report.views.push_back(
                {scene.test[first + i].name,
                 engine.measure(first + i, background, keeps || fits ? &renders[i] : nullptr),
                 {}});
        if (fits)
            for_each_in_parallel(count, [&](std::size_t i) {
                const view& v = scene.test[first + i];
                report.views[first + i].fitted_psnr = psnr_after_fit(renders[i], v.pixels, background);
            });
        if (!keeps) continue;
        for_each_in_parallel(2 * count, [&](std::size_t job) {
            const std::size_t i = job / 2;
            const bool drawn = job % 2 == 0;
            const view& v = scene.test[first + i];
            write_png(folder / (drawn ? "renders" : "gt") / names[first + i], v.camera.width, v.camera.height,
                      drawn ? renders[i] : over_background(v.pixels, background.data()));
        });
    }
    return report;
}

}  // namespace gs::evaluate
