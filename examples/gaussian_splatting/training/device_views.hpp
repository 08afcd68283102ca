// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "../core/error.hpp"
#include "../device/device.hpp"
#include "../metrics/target_image.hpp"
#include "../scene/image_pyramid.hpp"

namespace gs::train {

/// The training views at all size levels, and the held-out views, in device memory.
template <device::device Device>
class device_views {
  public:
    struct photo {
        gs::camera camera;
        std::size_t first;  ///< index of its first byte in the memory of all photos
        bool masked;        ///< whether it has a mask

        std::size_t pixels() const {
            return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
        }
    };

    explicit device_views(Device& device) : device_(device) {}

    /// Uploads the photos of all size levels, and the centers of the training cameras. Waits for
    /// the device.
    void set(const image_pyramid& levels, std::span<const view> held_out) {
        std::size_t bytes = 0;
        for (const auto views : levels) bytes += bytes_of(views);
        bytes_.resize(bytes + bytes_of(held_out));
        bytes = 0;
        train_.clear();
        for (const auto views : levels) train_.push_back(upload(views, bytes));
        held_out_ = upload(held_out, bytes);
        std::vector<glm::vec3> centers;
        for (const view& v : levels[0]) centers.emplace_back(v.camera.center());
        centers_.resize(centers.size());
        device_.upload(centers_.data(), centers.data(), centers.size());
        device_.wait();
    }

    /// Returns the training views, downsampled by two `level` times. Throws `error` if `set` got
    /// fewer levels.
    const std::vector<photo>& train(std::size_t level) const {
        if (level >= train_.size())
            throw error("the training views have " + std::to_string(train_.size()) +
                        " sizes, so they cannot be halved " + std::to_string(level) + " times");
        return train_[level];
    }
    std::size_t levels() const { return train_.size(); }
    const std::vector<photo>& smallest() const { return train_.back(); }
    const photo& held_out(std::size_t view) const { return held_out_[view]; }
    /// Returns the centers of the training cameras, in device memory.
    const glm::vec3* centers() const { return centers_.data(); }
    std::size_t count() const { return train_[0].size(); }

    const std::uint8_t* pixels(const photo& p) const { return bytes_.data() + p.first; }
    target_image target(const photo& p, const std::array<float, 3>& background) const {
        return {pixels(p), p.camera.width, p.camera.height, background, p.masked};
    }

  private:
    static std::size_t bytes_of(std::span<const view> views) {
        std::size_t bytes = 0;
        for (const view& v : views) bytes += v.pixels.rgba.size();
        return bytes;
    }
    std::vector<photo> upload(std::span<const view> views, std::size_t& first) {
        std::vector<photo> all;
        for (const view& v : views) {
            device_.upload(bytes_.data() + first, v.pixels.rgba.data(), v.pixels.rgba.size());
            all.push_back({v.camera, first, v.pixels.has_mask});
            first += v.pixels.rgba.size();
        }
        return all;
    }

    Device& device_;
    typename Device::template buffer<std::uint8_t> bytes_;
    typename Device::template buffer<glm::vec3> centers_;
    std::vector<std::vector<photo>> train_{1};
    std::vector<photo> held_out_;
};

}  // namespace gs::train
