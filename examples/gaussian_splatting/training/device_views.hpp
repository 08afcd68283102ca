// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "../device/device.hpp"
#include "../metrics/target_image.hpp"
#include "../scene/image_pyramid.hpp"
#include "photo_cache.hpp"

namespace gs::train {

/// The training views at all size levels, and the held-out views. Their photos are in device memory,
/// or a `photo_cache` loads them when they are needed.
template <device::device Device>
class device_views {
  public:
    struct photo {
        gs::camera camera;
        std::size_t view;   ///< number of the view, held-out views after training views
        std::size_t level;  ///< the photo is halved this many times
        cached_photo packed{};

        std::size_t pixels() const {
            return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
        }
    };
    /// A photo in device memory. See `photo_cache::get` for how long it is valid.
    struct loaded_photo {
        const photo& of;
        cached_photo packed;

        target_image target(const std::array<float, 3>& background) const {
            return {packed.bytes, of.camera.width, of.camera.height, background, packed.has_mask};
        }
        /// Returns the depth map, or null.
        const std::uint16_t* depths() const {
            if (!packed.has_depths) return nullptr;
            return reinterpret_cast<const std::uint16_t*>(packed.bytes + photos::depths_offset(of.camera));
        }
    };

    explicit device_views(Device& device) : device_(device) {}

    /// Sets the views, with training views of `downscales` smaller sizes. Uploads the photos, or
    /// starts a `photo_cache` if they are streamed. Waits for the device.
    void set(std::span<const view> train, std::span<const view> held_out, int downscales,
             const photos::photo_plan& plan) {
        cache_.reset();
        count_ = train.size();
        if (photos::any_is_streamed(train, held_out))
            stream(train, held_out, downscales, plan);
        else
            upload_all(train, held_out, downscales);
        std::vector<glm::vec3> centers;
        for (const view& v : train) centers.emplace_back(v.camera.center());
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
    const std::vector<photo>& held_out() const { return held_out_; }
    /// Returns the centers of the training cameras, in device memory.
    const glm::vec3* centers() const { return centers_.data(); }
    std::size_t count() const { return count_; }
    /// Returns the size of the device memory for photos.
    std::uint64_t photo_bytes() const { return cache_ != nullptr ? cache_->device_bytes() : bytes_.size(); }
    /// Returns the number of pixels of the largest view.
    std::size_t most_pixels() const {
        std::size_t most = 0;
        for (const auto* views : {&train_[0], &held_out_})
            for (const photo& p : *views) most = std::max(most, p.pixels());
        return most;
    }

    /// Returns the photo in device memory. May wait until it is decoded.
    loaded_photo load(const photo& p) {
        return {p, cache_ != nullptr ? cache_->get(p.view, p.level) : p.packed};
    }
    /// Returns the photo of `views[index]`, and expects those after it.
    loaded_photo load_in_order(const std::vector<photo>& views, std::size_t index) {
        if (cache_ != nullptr) {
            std::vector<photos::photo_request> next;
            const std::size_t end = std::min(views.size(), index + cache_->look_ahead());
            for (std::size_t i = index; i < end; ++i) next.push_back({views[i].view, views[i].level});
            cache_->expect(std::move(next));
        }
        return load(views[index]);
    }
    /// Returns the cache of streamed photos, or null.
    photo_cache<Device>* cache() const { return cache_.get(); }

  private:
    void stream(std::span<const view> train, std::span<const view> held_out, int downscales,
                const photos::photo_plan& plan) {
        bytes_ = {};
        train_.assign(1, {});
        for (const view& v : train) train_[0].push_back({v.camera, train_[0].size(), 0});
        for (std::size_t level = 1; level <= static_cast<std::size_t>(downscales); ++level) {
            train_.emplace_back();
            for (const photo& p : train_[0])
                train_[level].push_back({downsampled(p.camera, 1 << level), p.view, level});
        }
        held_out_.clear();
        for (const view& v : held_out) held_out_.push_back({v.camera, count_ + held_out_.size(), 0});
        std::vector<view> all(train.begin(), train.end());
        all.insert(all.end(), held_out.begin(), held_out.end());
        cache_ = std::make_unique<photo_cache<Device>>(device_, std::move(all), plan);
    }

    void upload_all(std::span<const view> train, std::span<const view> held_out, int downscales) {
        const auto smaller = downsampled_levels(train, downscales);
        std::vector<std::span<const view>> levels{train};
        levels.insert(levels.end(), smaller.begin(), smaller.end());
        std::size_t bytes = bytes_of(held_out);
        for (const auto views : levels) bytes += bytes_of(views);
        bytes_.resize(bytes);
        bytes = 0;
        train_.clear();
        for (const auto views : levels) train_.push_back(upload(views, 0, train_.size(), bytes));
        held_out_ = upload(held_out, count_, 0, bytes);
        device_.wait();
    }
    static std::size_t bytes_of(std::span<const view> views) {
        std::size_t bytes = 0;
        for (const view& v : views) bytes += photos::packed_bytes(v.camera, v.depths.is_there());
        return bytes;
    }
    std::vector<photo> upload(std::span<const view> views, std::size_t number, std::size_t level,
                              std::size_t& first) {
        std::vector<photo> all;
        for (const view& v : views) {
            std::uint8_t* to = bytes_.data() + first;
            device_.upload(to, v.pixels.rgba.data(), v.pixels.rgba.size());
            device_.upload(reinterpret_cast<std::uint16_t*>(to + v.pixels.rgba.size()),
                           v.depths.values.data(), v.depths.values.size());
            all.push_back({v.camera, number++, level, {to, v.pixels.has_mask, v.depths.is_there()}});
            first += photos::packed_bytes(v.camera, v.depths.is_there());
        }
        return all;
    }

    Device& device_;
    typename Device::template buffer<std::uint8_t> bytes_;
    typename Device::template buffer<glm::vec3> centers_;
    std::vector<std::vector<photo>> train_{1};
    std::vector<photo> held_out_;
    std::size_t count_ = 0;
    std::unique_ptr<photo_cache<Device>> cache_;
};

}  // namespace gs::train
