// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <warpagg/core/math.hpp>

#include "../features/device_features.hpp"
#include "../losses/loss.hpp"

namespace gs::train {

/// Copies the first columns of an image, three planes, and sets the rest to zero. One index per value.
struct first_columns {
    const float* from;
    float* to;
    std::size_t width, columns;

    WARPAGG_HD void operator()(std::size_t i) const { to[i] = i % width < columns ? from[i] : 0.0f; }
};

/// Returns the camera of a held-out view with a refined pose: see `learned_cameras`. `draw`
/// renders a camera with the renderer. `target` is the view's photo. Effects that features have on the
/// render, such as exposures, pass the gradient through unchanged.
template <class Renderer, class Draw>
camera refine_pose(typename Renderer::device_type& device, Renderer& renderer,
                   features::device_features<Renderer>& features, loss<float>& loss,
                   const target_image& target, std::size_t test_view, const camera& given,
                   accumulator accumulate, const Draw& draw) {
    constexpr int steps = 200;
    typename Renderer::template buffer<float> left;
    // Windows of the loss extend this far, so the other columns depend on the right half.
    const int columns = given.width / 2 - std::min(loss.reach(), given.width / 2);
    step_plan plan;
    plan.view = test_view;
    loss.set_target(target);
    features.begin_refinement();
    camera seen = features.refined(given);
    for (int i = 0; i < steps; ++i) {
        draw(seen);
        const features::step<Renderer> s{plan,      seen, target, nullptr, renderer, loss.gradient_scale(),
                                         accumulate};
        left.resize(3 * s.pixels());
        const float* gradient = loss.gradient(
            features.show_held_out(test_view, renderer.render(), s.pixels()), renderer.capacity());
        device.for_each_index(left.size(),
                              first_columns{gradient, left.data(), static_cast<std::size_t>(given.width),
                                            static_cast<std::size_t>(columns)});
        const float* sums = renderer.backward_to_splats(left.data(), s.gradient_scale, accumulate);
        features.refine_pose(s, sums, static_cast<double>(i) / steps);
        seen = features.refined(given);
    }
    return seen;
}

}  // namespace gs::train
