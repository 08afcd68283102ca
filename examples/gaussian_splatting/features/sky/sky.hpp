// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../device/device.hpp"
#include "../../optimize/adam_parameters.hpp"
#include "../../render/geometry/effect_set.hpp"
#include "sky_kernels.hpp"

namespace gs::features {

/// The learned background of a model on the device, if it has one.
template <device::device Device>
class sky {
    using warp = typename Device::warp;
    using real = warpagg::value_t<warp, float>;

  public:
    explicit sky(Device& device) : device_(device), numbers_(device) {}

    /// Sets the `sky_width` coefficients. An empty list removes the learned background.
    void set(const std::vector<float>& coefficients) { numbers_.set(coefficients); }
    std::vector<float> get() const { return numbers_.get(); }
    void exchange(state_archive& archive) { numbers_.exchange(archive); }
    bool exists() const { return numbers_.rows() > 0; }

    /// Draws the background of a camera. Returns three planes on the device, or null without a
    /// learned background.
    const float* draw(const camera& camera) {
        if (!exists()) return nullptr;
        raster::require_drawable(camera);
        planes_.resize(3 * static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
        raster::with_lens(camera.lens(), [&]<lens_model Lens> {
            device_.for_each_warp(patches(camera), draw_sky<warp, Lens>{raster::for_device<real>(camera),
                                                                        numbers_.row(0), planes_.data()});
        });
        return planes_.data();
    }

    /// Trains the coefficients from `by_render`, the gradient with respect to a render with this
    /// background. `transmittance` is the share of the background's light in each pixel. Both must exist
    /// in `rows`; other ranks have the other rows.
    void learn(const camera& camera, const float* transmittance, const float* by_render, float rate,
               const raster::list_capacity& capacity, const row_range& rows = {}) {
        const train::ordered_sums sums = numbers_.sums(patches(camera));
        const image_part part{camera.width, camera.height, rows};
        raster::with_lens(camera.lens(), [&]<lens_model Lens> {
            device_.for_each_warp(
                pixel_patch<warp>::count_in(part),
                sky_backward<warp, Lens>{raster::for_device<real>(camera), transmittance, by_render, sums,
                                         pixel_patch<warp>::first_in(part)});
        });
        numbers_.learn(0, sums, rate, capacity);
    }

  private:
    static std::size_t patches(const camera& camera) {
        return pixel_patch<warp>::count(camera.width, camera.height);
    }

    Device& device_;
    train::adam_parameters<Device, sky_width> numbers_;
    typename Device::template buffer<float> planes_;
};

}  // namespace gs::features
