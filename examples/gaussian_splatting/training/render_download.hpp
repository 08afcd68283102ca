// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>
#include <warpagg/core/compiler.hpp>

#include "../device/device.hpp"
#include "../engine/render_options.hpp"
#include "../scene/camera.hpp"

namespace gs::train {

/// Averages the planes of an image over square blocks of pixels. One index per block of each plane.
struct average_blocks {
    const float* planes;
    std::size_t width, pixels;        ///< of the image
    std::size_t side, across, count;  ///< of the blocks
    float* means;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t block = i % count, first_row = block / across * side;
        const float* const plane = planes + i / count * pixels + block % across * side;
        float sum = 0;
        for (std::size_t row = first_row; row < first_row + side; ++row)
            for (std::size_t x = 0; x < side; ++x) sum += plane[row * width + x];
        means[i] = sum / static_cast<float>(side * side);
    }
};

/// Copies some pixels of the planes of an image. One index per pixel of each plane.
struct take_pixels {
    const float* planes;
    std::size_t pixels;  ///< of the image
    const std::uint32_t* places;
    std::size_t count;
    float* taken;

    WARPAGG_HD void operator()(std::size_t i) const {
        taken[i] = planes[i / count * pixels + places[i % count]];
    }
};

/// Copies renders to the host, or the part of them that `render_options` ask for. The part is made on the
/// device, because copies of large images take longer than drawing them.
template <device::device Device>
class render_download {
  public:
    explicit render_download(Device& device) : device_(device) {}

    /// Returns the part of some planes of the camera's size. Waits for the device.
    std::vector<float> operator()(const float* planes, std::size_t plane_count, const camera& camera,
                                  const render_options& options = {}) {
        const auto width = static_cast<std::size_t>(camera.width),
                   height = static_cast<std::size_t>(camera.height), pixels = width * height;
        if (const std::size_t count = options.pixels.size(); count > 0) {
            places_.resize(count);
            device_.upload(places_.data(), options.pixels.data(), count);
            return made(plane_count * count, [&](float* to) {
                return take_pixels{planes, pixels, places_.data(), count, to};
            });
        }
        if (options.block > 1) {
            const auto side = static_cast<std::size_t>(options.block);
            const std::size_t across = width / side, count = across * (height / side);
            return made(plane_count * count, [&](float* to) {
                return average_blocks{planes, width, pixels, side, across, count, to};
            });
        }
        std::vector<float> all(plane_count * pixels);
        device_.download(all.data(), planes, all.size());
        return all;
    }

  private:
    template <class MakeKernel>
    std::vector<float> made(std::size_t values, const MakeKernel& kernel) {
        part_.resize(values);
        device_.for_each_index(values, kernel(part_.data()));
        std::vector<float> part(values);
        device_.download(part.data(), part_.data(), values);
        return part;
    }

    Device& device_;
    typename Device::template buffer<std::uint32_t> places_;
    typename Device::template buffer<float> part_;
};

}  // namespace gs::train
