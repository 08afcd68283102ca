// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "densify/adaptive/densify_config.hpp"
#include "lab/accumulators.hpp"
#include "metrics/image_quality.hpp"
#include "model/parameters.hpp"
#include "render/geometry/effect_set.hpp"
#include "scene/scene.hpp"

/// The hard cases of numerics: one text of tests, put to every device. All numbers are doubles here, and
/// become the device's own on their way there.
namespace hard_cases {

using gs::accumulator;

/// An image of a few Gaussians and a photo to compare it with.
struct render_case {
    int sh_degree = 3;
    gs::effect_set effects;
    std::array<std::vector<double>, gs::parameter_count> parameters;
    gs::view view;
    std::array<float, 3> background{};
    std::vector<double> background_image;  ///< three planes behind all, in place of the background; or none
    /// Of what the loss has beside: the sum of the inverse depths, each times this, one a pixel; or none.
    std::vector<double> depth_weights;
    accumulator how = accumulator::native;
    std::vector<double> weights;  ///< of the loss's gradient, one a pixel; none for 1 everywhere
    /// The image at which the loss's gradient is taken; none for the one that is drawn.
    std::vector<double> gradient_at;

    std::size_t count() const { return parameters[3].size(); }
    std::size_t pixels() const {
        return static_cast<std::size_t>(view.camera.width) * static_cast<std::size_t>(view.camera.height);
    }
};

/// The statistics of a Gaussian for densification.
struct sighting {
    double gradient = 0, seen = 0;
};

struct render_result {
    std::vector<double> render;  ///< three planes, as all images here
    double loss = 0;
    std::array<std::vector<double>, gs::parameter_count> gradients;
    std::vector<sighting> sightings;
};

/// A Gaussian in the image, as the renderer's `splat`.
struct projected_splat {
    bool drawn;
    std::uint32_t depth;  ///< sort key
    double x, y, cutoff, opacity, p, q, r, red, green, blue;

    bool operator==(const projected_splat&) const = default;
};

/// A splat made by hand: the covariance is the Gram matrix of `across` and `down`, in pixels, widened by the
/// pixel's filter.
struct flat_splat {
    double x, y, opacity;
    std::array<double, 3> across{}, down{};
    std::array<double, 3> color{};
};

/// Splats to be blended, without Gaussians behind them.
struct blend_case {
    int width, height;
    std::array<float, 3> background{};
    std::vector<flat_splat> splats;
    std::vector<std::vector<std::uint32_t>> lists;  ///< front to back, one a tile; none for all in each
    std::vector<double> gradient;                   ///< by the image; empty: forward only
    accumulator how = accumulator::native;
};

struct blend_result {
    std::vector<double> render, transmittance;
    std::vector<std::uint32_t> last;
    /// By splat: of red, green, blue, of dL/dalpha alpha, and its five moments.
    std::vector<std::array<double, 9>> sums;
};

/// An image beside a photo, premultiplied RGBA over a background.
struct compare_case {
    int width, height;
    std::vector<double> render;
    std::vector<std::uint8_t> rgba;
    std::array<float, 3> background{};
};

struct compare_result {
    gs::train::image_quality quality;
    double loss;
    std::vector<double> gradient;  ///< of the training loss, by the image
};

/// Who stays and how urgently each wants to grow: the smaller the key the more.
struct judgment {
    std::vector<std::uint32_t> stays, urgency;
    std::uint64_t without_gradient;  ///< were drawn and took no gradient
};

/// What goes to each bucket, in the order of the items, up to the capacity; and how much that is
/// without the bound.
struct bucket_lists {
    std::vector<std::vector<std::uint32_t>> items;
    std::uint64_t required;
};

/// The kernels on one device. Each function waits for its result.
struct backend {
    std::string name;
    unsigned lanes;  ///< of a warp

    std::string (*device_name)();
    render_result (*render)(const render_case&);
    double (*loss)(const render_case&);  ///< that of `render`, without gradients
    std::vector<projected_splat> (*project)(const render_case&);
    blend_result (*blend)(const blend_case&);
    compare_result (*compare)(const compare_case&);
    /// Values after each step of Adam from 0: `gradients[step][value]`. `takes_part`, alike, is none for all.
    /// The first step's number is `steps_before` + 1.
    std::vector<std::vector<double>> (*descend)(const std::vector<std::vector<double>>& gradients,
                                                double rate,
                                                const std::vector<std::vector<std::uint32_t>>& takes_part,
                                                std::uint32_t steps_before);
    judgment (*judge)(const std::vector<sighting>&, const std::vector<double>& opacities,
                      const gs::train::densify_config&);
    std::vector<std::uint64_t> (*prefix_sum)(const std::vector<std::uint32_t>&);
    /// The numbers from 0, sorted by their keys.
    std::vector<std::uint32_t> (*sort)(const std::vector<std::uint32_t>& keys);
    /// Items with the buckets that each goes to, `no_bucket` among them. All lists move by `moved` places.
    bucket_lists (*distribute)(const std::vector<std::vector<std::uint32_t>>& items, std::size_t buckets,
                               std::uint64_t capacity, std::uint32_t moved);
    /// What a renderer says to this many instances of a view; nothing if it takes them.
    std::string (*complaint_about_instances)(std::uint64_t);
    /// The library's sum of all values into one address.
    double (*sum)(const std::vector<double>&, accumulator);
};

/// Double precision with one lane per warp: the reference for all others.
const backend& reference();
/// Those in float that are to be measured: lanes, 8 and 32 a warp, serial, and the GPU where the build has
/// one.
const std::vector<backend>& backends();

backend lanes_backend();
backend lanes_32_backend();
backend serial_backend();
backend cuda_backend();

}  // namespace hard_cases
