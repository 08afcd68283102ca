// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "training_views.hpp"

#include <algorithm>
#include <cmath>

#include "../scene/view_photo.hpp"

namespace gs::evaluate {

double training_view_images::psnr() const {
    double sum = 0;
    for (std::size_t i = 0; i < render.size(); ++i) sum += std::pow(double(render[i]) - double(target[i]), 2);
    return 10 * std::log10(static_cast<double>(render.size() - 3 * masked) / sum);
}

training_view_images training_view(train::engine& engine, const scene& scene,
                                   const features::show_function& show,
                                   const std::array<float, 3>& background, std::size_t view) {
    const gs::view& shown = scene.train[view];
    training_view_images images{
        engine.render(engine.cameras().training_camera(view, shown.camera), background), {}, 0};
    if (show) show(view, {shown.camera.width, shown.camera.height}, images.render);
    const view_photo photo(shown);
    images.target = over_background(photo.pixels(), background.data());
    const std::size_t pixels = images.target.size() / 3;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const bool is_masked = photo.pixels().is_masked(pixel);
        images.masked += is_masked ? 1 : 0;
        for (std::size_t i = pixel; i < images.target.size(); i += pixels)
            images.render[i] = is_masked ? images.target[i] : std::clamp(images.render[i], 0.0F, 1.0F);
    }
    return images;
}

}  // namespace gs::evaluate
