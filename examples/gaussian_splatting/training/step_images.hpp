// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "../device/device.hpp"
#include "../features/device_features.hpp"
#include "../losses/loss.hpp"
#include "device_views.hpp"

namespace gs::train {

/// Planes of a view, and of a picture with several views: see `raster::view_stack`.
struct planes_in_picture {
    std::size_t width, height;                  ///< of the view
    std::size_t picture_width, picture_pixels;  ///< of the picture
    std::size_t first_row;                      ///< of the view in the picture

    WARPAGG_HD std::size_t in_view(std::size_t plane, std::size_t y, std::size_t x) const {
        return (plane * height + y) * width + x;
    }
    WARPAGG_HD std::size_t in_picture(std::size_t plane, std::size_t y, std::size_t x) const {
        return plane * picture_pixels + (first_row + y) * picture_width + x;
    }
};

/// Copies rows of a view from a picture. One index per pixel.
struct cut_view {
    planes_in_picture planes;
    std::size_t count;  ///< number of planes
    std::size_t first;  ///< row
    const float* picture;
    float* view;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t y = first + i / planes.width, x = i % planes.width;
        for (std::size_t p = 0; p < count; ++p)
            view[planes.in_view(p, y, x)] = picture[planes.in_picture(p, y, x)];
    }
};

/// Copies rows of a view to a picture. Pixels beside and below the view, or all without a view, become zero.
/// One index per pixel of these rows of the picture.
struct paste_view {
    planes_in_picture planes;
    std::size_t first;  ///< row
    const float* view;  ///< may be null
    float* picture;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t y = first + i / planes.picture_width, x = i % planes.picture_width;
        const bool is_in_view = view != nullptr && y < planes.height && x < planes.width;
        for (std::size_t p = 0; p < 3; ++p)
            picture[planes.in_picture(p, y, x)] = is_in_view ? view[planes.in_view(p, y, x)] : 0;
    }
};

/// The images of a step, of one view or several. The renderer draws all views as one picture, and losses and
/// features see each view by itself.
template <class Renderer>
class step_images {
    using device = typename Renderer::device_type;
    using all_features = features::device_features<Renderer>;
    using step = features::step<Renderer>;
    template <class T>
    using buffer = typename Renderer::template buffer<T>;

  public:
    /// All arguments must exist as long as this object.
    step_images(device& on, Renderer& renderer, all_features& features)
        : device_(on), renderer_(renderer), features_(features) {}

    /// Begins a step with some training views of a size, and loads their photos. Gradient scales are not
    /// known yet.
    std::vector<step> begin(step_plan plan, const std::vector<std::size_t>& views, device_views<device>& all,
                            const std::vector<typename device_views<device>::photo>& photos,
                            accumulator accumulate) {
        std::vector<step> steps;
        for (const std::size_t view : views) {
            plan.view = view;
            const auto loaded = all.load(photos[view]);
            steps.push_back({plan, features_.seen_by(view, photos[view].camera),
                             loaded.target(plan.background), loaded.depths(), renderer_, 0, accumulate,
                             steps.size()});
        }
        return steps;
    }
    /// Returns the picture with all views of a step.
    static raster::view_stack picture_of(std::span<const step> steps) {
        std::vector<camera> views;
        for (const step& s : steps) views.push_back(s.camera);
        return raster::view_stack(std::move(views));
    }

    /// Lets features learn from depth maps. Runs between `renderer::list` and `renderer::blend`. `reach`: see
    /// `loss::reach`.
    void learn_depths(std::span<const step> steps, int reach) {
        bool any = false;
        for (const step& s : steps) any = any || features_.learns_depths(s);
        if (!any) return;
        renderer_.blend_depths();
        const float* gradient = nullptr;
        for (const step& s : steps) {
            gradient = features_.depth_gradient(s, cut(s, renderer_.render(), 3, reach, render_));
            if (steps.size() > 1) gradient = paste_own(s, gradient);
        }
        renderer_.backward_depths(gradient, steps[0].gradient_scale, steps[0].accumulate);
    }
    /// Returns the background that features have learned, three planes of the picture, or null.
    const float* background(std::span<const step> steps) {
        const float* planes = nullptr;
        for (const step& s : steps) {
            planes = features_.background(s.camera);
            if (planes == nullptr) return nullptr;
            if (steps.size() > 1) planes = paste(s, planes, {0, s.camera.height}, background_);
        }
        return planes;
    }
    /// Compares the render of each view with its photo, and lets features learn from it. Returns the gradient
    /// with respect to the picture.
    const float* learn(std::span<step> steps, loss<float>& loss) {
        const float* gradient = nullptr;
        for (step& s : steps) {
            loss.set_target(s.target);
            s.transmittance = cut(s, renderer_.transmittance(), 1, loss.reach(), transmittance_);
            const float* render = cut(s, renderer_.render(), 3, loss.reach(), render_);
            const float* by_shown = loss.gradient(features_.show(s, render), renderer_.capacity());
            gradient = features_.backward(s, by_shown);
            features_.learn(s, gradient);
            if (steps.size() > 1) gradient = paste_own(s, gradient);
        }
        return gradient;
    }

  private:
    planes_in_picture planes_of(const step& s) const {
        const raster::view_stack& picture = renderer_.views();
        return {static_cast<std::size_t>(s.camera.width), static_cast<std::size_t>(s.camera.height),
                static_cast<std::size_t>(picture.width()), picture.pixels(),
                static_cast<std::size_t>(picture.first_row(s.place))};
    }
    /// Returns planes of a view: this rank's own rows, and `reach` more on both sides.
    const float* cut(const step& s, const float* picture, std::size_t planes, int reach,
                     buffer<float>& view) {
        if (renderer_.views().count() == 1) return picture;
        view.resize(planes * s.pixels());
        const row_range rows = renderer_.own_rows(s.place).grown(reach, s.camera.height);
        device_.for_each_index(
            static_cast<std::size_t>(rows.count()) * static_cast<std::size_t>(s.camera.width),
            cut_view{planes_of(s), planes, static_cast<std::size_t>(rows.first), picture, view.data()});
        return view.data();
    }
    /// Pastes rows of three planes of a view into those of the picture, with the rest of the last tile row.
    const float* paste(const step& s, const float* view, row_range rows, buffer<float>& picture) {
        const raster::view_stack& all = renderer_.views();
        picture.resize(3 * all.pixels());
        if (rows.last == s.camera.height)
            rows.last = (rows.last + raster::tile_size - 1) / raster::tile_size * raster::tile_size;
        device_.for_each_index(
            static_cast<std::size_t>(rows.count()) * static_cast<std::size_t>(all.width()),
            paste_view{planes_of(s), static_cast<std::size_t>(rows.first), view, picture.data()});
        return picture.data();
    }
    /// Pastes the rows of this rank into the gradient.
    const float* paste_own(const step& s, const float* view) {
        return paste(s, view, renderer_.own_rows(s.place), gradient_);
    }

    device& device_;
    Renderer& renderer_;
    all_features& features_;
    buffer<float> render_, transmittance_, gradient_, background_;
};

}  // namespace gs::train
