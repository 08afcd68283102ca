// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "run_images.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../evaluation/held_out_views.hpp"
#include "../evaluation/training_views.hpp"
#include "../pages/picture.hpp"

namespace gs::cli {

namespace {

std::optional<double> known(double psnr) { return std::isnan(psnr) ? std::nullopt : std::optional(psnr); }

}  // namespace

held_out_images held_out_images_of(const std::filesystem::path& folder,
                                   const nlohmann::ordered_json& metrics) {
    held_out_images all;
    const std::string iterations =
        std::to_string(std::llround(pages::number_in(metrics, {"iterations"}).value_or(0)));
    const std::filesystem::path images = folder / "test" / ("ours_" + iterations);
    all.photos = images / "gt";
    all.renders = images / "renders";
    if (!metrics.contains("views") || !metrics["views"].is_array()) return all;
    std::vector<view> named;
    for (const auto& entry : metrics["views"]) {
        all.names.push_back(pages::text_in(entry, "name"));
        all.psnr.push_back(pages::number_in(entry, {"psnr"}).value_or(std::nan("")));
        named.emplace_back().name = all.names.back();
    }
    all.files = evaluate::render_names(named);
    return all;
}

std::vector<pages::view_images> typical_held_out_views(const held_out_images& views) {
    std::vector<pages::view_images> chosen;
    for (const auto& [view, label] : pages::typical_views(views.psnr))
        chosen.push_back({views.names[view], label, known(views.psnr[view]), read_image(views.photo(view)),
                          read_image(views.render(view))});
    return chosen;
}

std::vector<pages::view_images> typical_training_views(train::engine& engine, const scene& scene,
                                                       const features::feature_set& features,
                                                       const std::array<float, 3>& background,
                                                       ranks::communicator& ranks) {
    constexpr std::size_t most_views = 12;
    const features::show_function show = features.show_on_host(engine, scene);
    const auto images_of = [&](std::size_t view) {
        return evaluate::training_view(engine, scene, show, background, view);
    };
    const std::size_t count = scene.train.size(), rendered = std::min(count, most_views);
    const ranks::shares shares(rendered, 1, ranks.count());
    const ranks::share own = shares.of(ranks.rank());
    std::vector<double> psnr(rendered);
    for (std::size_t i = own.first; i < own.last; ++i) psnr[i] = images_of(i * count / rendered).psnr();
    const auto array = ranks::shared_array::of(psnr.data(), 1, rendered);
    ranks.gather(shares, {&array, 1});
    std::vector<pages::view_images> chosen;
    if (!ranks.is_first()) return chosen;
    for (const auto& [rank, label] : pages::typical_views(psnr)) {
        const std::size_t view = rank * count / rendered;
        const gs::view& shown = scene.train[view];
        const evaluate::training_view_images images = images_of(view);
        const auto image_of = [&](const std::vector<float>& planes) {
            return pages::image_of(shown.camera.width, shown.camera.height, planes);
        };
        chosen.push_back({shown.name, label, psnr[rank], image_of(images.target), image_of(images.render)});
    }
    return chosen;
}

std::string last_part(const std::filesystem::path& relative) {
    const std::filesystem::path path = std::filesystem::absolute(relative).lexically_normal();
    return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace gs::cli
