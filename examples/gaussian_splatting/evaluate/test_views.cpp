// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "test_views.hpp"

#include <algorithm>
#include <set>

namespace gs::evaluate {

namespace {

template <class Measure>
double mean(const std::vector<view_quality>& views, Measure measure) {
    double sum = 0;
    for (const view_quality& v : views) sum += measure(v.quality);
    return sum / static_cast<double>(views.size());
}

}  // namespace

std::vector<std::string> picture_names(const std::vector<view>& views) {
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

double test_report::psnr() const {
    return mean(views, [](const train::quality& q) { return q.psnr(); });
}
double test_report::ssim() const {
    return mean(views, [](const train::quality& q) { return q.ssim; });
}

test_report measure_test_views(train::engine& engine, const scene& scene,
                               const std::array<float, 3>& background, const std::filesystem::path& folder) {
    test_report report;
    if (!folder.empty()) {
        std::filesystem::create_directories(folder / "renders");
        std::filesystem::create_directories(folder / "gt");
    }
    const auto names = picture_names(scene.test);
    for (std::size_t i = 0; i < scene.test.size(); ++i) {
        const view& v = scene.test[i];
        report.views.push_back({v.name, engine.measure(i, background)});
        if (folder.empty()) continue;
        const std::string& name = names[i];
        write_png(folder / "renders" / name, v.camera.width, v.camera.height,
                  engine.render(v.camera, background));
        write_png(folder / "gt" / name, v.camera.width, v.camera.height,
                  over_background(v.pixels, background.data()));
    }
    return report;
}

}  // namespace gs::evaluate
