// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "../device/device.hpp"
#include "../engine/photo_prefetch.hpp"
#include "../photos/packed_photo.hpp"
#include "../photos/photo_plan.hpp"
#include "../photos/photo_stream.hpp"
#include "../scene/downsample.hpp"

namespace gs::train {

/// A packed photo in device memory: see `photos::pack`.
struct cached_photo {
    const std::uint8_t* bytes = nullptr;
    bool has_mask = false;
    bool has_depths = false;
};

/// The photos of streamed views in device memory. Some views keep their place as long as the size
/// level stays the same. The others share a few slots. Photos are uploaded before they are needed,
/// beside the steps of other views.
template <device::device Device>
class photo_cache final : public photo_prefetch {
    using request = photos::photo_request;

  public:
    /// Starts the threads of a `photo_stream`. Training views come first.
    photo_cache(Device& device, std::vector<view> views, const photos::photo_plan& plan)
        : device_(device),
          staged_(plan.staged),
          transfers_(plan.staged),
          slots_(plan.slots),
          host_bytes_(plan.host_bytes) {
        std::vector<std::uint8_t*> buffers;
        for (auto& b : staged_) {
            b.resize(plan.photo_bytes);
            buffers.push_back(b.data());
        }
        for (slot& s : slots_) s.memory.resize(plan.photo_bytes);
        lasting_.resize(plan.device_bytes);
        device_.wait();
        for (const view& v : views) sizes_.push_back({v.camera, v.depths.is_there(), photos::kept_bytes(v)});
        stream_ = std::make_unique<photos::photo_stream>(std::move(views), plan.workers, buffers);
        set_level(0);
    }
    ~photo_cache() override {
        try {  // the error that ends training has been thrown
            device_.wait();
            release_uploaded(true);
        } catch (const error&) {
        }
    }
    photo_cache(const photo_cache&) = delete;
    photo_cache& operator=(const photo_cache&) = delete;

    /// Gives lasting places to the first views, as many as fit at this size level. Host memory that
    /// remains is for larger sizes of the views that stay there.
    void set_level(std::size_t level) {
        level_ = level;
        places_ = places_at(level);
        std::uint64_t left = host_bytes_;
        std::vector<photos::level_range> kept(places_.size());
        for (std::size_t larger = level + 1; larger-- > 0;) {
            const std::vector<place> places = places_at(larger);
            for (std::size_t v = 0; v < places.size(); ++v) {
                const std::uint64_t bytes = kept_bytes_of({v, larger});
                if (places[v].stays_on_host && bytes <= left && kept[v].extend_to(larger)) left -= bytes;
            }
        }
        stream_->keep(std::move(kept));
    }

    /// Returns the size of the device memory for photos.
    std::uint64_t device_bytes() const {
        std::uint64_t bytes = lasting_.size();
        for (const slot& s : slots_) bytes += s.memory.size();
        return bytes;
    }

    std::size_t look_ahead() const override { return staged_.size() + slots_.size(); }
    void expect(std::vector<request> next) override {
        expected_ = std::move(next);
        for (slot& s : slots_) s.is_needed = s.is_needed && is_expected(s.of);
        std::vector<request> missing;
        for (const request& r : expected_)
            if (!find(r)) missing.push_back(r);
        stream_->expect(std::move(missing));
    }

    /// Returns a photo. Waits until it is decoded. Launches that follow may use it, up to the next call of
    /// `upload_ahead`, or of `get` with more other photos than `photo_plan` had at once. Throws the error of
    /// a photo that cannot be decoded.
    cached_photo get(std::size_t view, std::size_t level) {
        const request r{view, level};
        if (!find(r)) {
            if (!stream_->is_ready(r)) release_uploaded(true);
            upload(r);
        }
        for (const photos::staged_photo& s : uploads_)
            if (s.of == r) device_.await(transfers_[s.number]);
        for (slot& s : slots_)
            if (s.holds(r)) {
                s.is_needed = false;
                s.last_use = ++uses_;
            }
        return *find(r);
    }

    /// Begins to upload expected photos that are decoded, as far as there are places. Call it after the
    /// launches of a step.
    void upload_ahead() {
        release_uploaded(false);
        for (const request& r : expected_)
            if (!find(r) && (place_of(r) != nullptr || has_free_slot()) && stream_->is_ready(r)) upload(r);
    }

    std::exception_ptr failure_ahead(std::size_t of_step) override {
        for (std::size_t i = of_step; i < std::min(2 * of_step, expected_.size()); ++i) {
            if (find(expected_[i])) continue;
            if (!stream_->is_ready(expected_[i])) release_uploaded(true);
            if (const auto failure = stream_->failure_of(expected_[i])) return failure;
        }
        return nullptr;
    }

  private:
    static constexpr std::uint64_t none = photos::photo_limits::none;

    struct photo_size {
        camera full;
        bool has_depths;
        std::uint64_t kept_bytes;  ///< on the host, in full size
    };
    /// The lasting place of a view, at the size level of the cache.
    struct place {
        std::uint64_t first = none;  ///< index of its first byte, or `none`
        bool stays_on_host = false;
        std::optional<cached_photo> photo;
    };
    struct slot {
        typename Device::template buffer<std::uint8_t> memory;
        request of;
        std::optional<cached_photo> photo;
        bool is_needed = false;  ///< whether it is expected and was not used
        std::uint64_t last_use = 0;

        bool holds(const request& r) const { return photo && of == r; }
    };

    std::uint64_t packed_bytes_of(const request& r) const {
        const photo_size& size = sizes_[r.view];
        return photos::packed_bytes(r.level == 0 ? size.full : downsampled(size.full, 1 << r.level),
                                    size.has_depths);
    }
    /// Returns the size of a photo in host memory.
    std::uint64_t kept_bytes_of(const request& r) const {
        return r.level == 0 ? sizes_[r.view].kept_bytes : packed_bytes_of(r);
    }
    /// Returns the places of the views at a size level.
    std::vector<place> places_at(std::size_t level) const {
        std::vector<place> places(sizes_.size());
        std::uint64_t used = 0, kept = 0;
        for (std::size_t v = 0; v < sizes_.size(); ++v) {
            const std::uint64_t bytes = packed_bytes_of({v, level});
            const std::uint64_t on_host = kept_bytes_of({v, level});
            if (used + bytes <= lasting_.size()) {
                places[v].first = std::exchange(used, used + bytes);
            } else if (kept + on_host <= host_bytes_) {
                kept += on_host;
                places[v].stays_on_host = true;
            }
        }
        return places;
    }
    place* place_of(const request& r) {
        return r.level == level_ && places_[r.view].first != none ? &places_[r.view] : nullptr;
    }
    std::optional<cached_photo> find(const request& r) {
        if (const place* p = place_of(r); p != nullptr && p->photo) return p->photo;
        for (const slot& s : slots_)
            if (s.holds(r)) return s.photo;
        return std::nullopt;
    }
    bool is_expected(const request& r) const {
        return std::ranges::any_of(expected_, [&](const request& e) { return e == r; });
    }
    bool has_free_slot() const { return !std::ranges::all_of(slots_, &slot::is_needed); }

    /// Takes a photo from the stream and begins its upload.
    void upload(const request& r) {
        const photos::staged_photo& staged = stream_->take(r);
        cached_photo photo{nullptr, staged.has_mask, staged.has_depths};
        std::uint8_t* to = nullptr;
        if (place* p = place_of(r); p != nullptr) {
            photo.bytes = to = lasting_.data() + p->first;
            p->photo = photo;
        } else {
            slot& s = slot_to_replace();
            photo.bytes = to = s.memory.data();
            s = {std::move(s.memory), r, photo, is_expected(r), ++uses_};
        }
        uploads_.push_back(staged);
        device_.begin_upload(transfers_[staged.number], to, staged.bytes, packed_bytes_of(r));
    }
    /// Returns the slot that was unused for the longest time. It is one that is not needed if there is
    /// one.
    slot& slot_to_replace() {
        return *std::ranges::min_element(slots_, [](const slot& a, const slot& b) {
            return std::pair(a.is_needed, a.last_use) < std::pair(b.is_needed, b.last_use);
        });
    }
    /// Returns the buffers of finished uploads to the stream, or all after waiting for them.
    void release_uploaded(bool waits) {
        std::erase_if(uploads_, [&](const photos::staged_photo& s) {
            if (waits) transfers_[s.number].wait();
            if (!transfers_[s.number].is_done()) return false;
            stream_->release(s);
            return true;
        });
    }

    Device& device_;
    std::vector<typename Device::template host_buffer<std::uint8_t>> staged_;
    std::vector<typename Device::transfer> transfers_;  ///< by number of the staged photo
    std::vector<slot> slots_;
    typename Device::template buffer<std::uint8_t> lasting_;
    std::vector<photo_size> sizes_;
    std::vector<place> places_;  ///< by view
    std::uint64_t host_bytes_;
    std::size_t level_ = 0;
    std::uint64_t uses_ = 0;
    std::vector<request> expected_;
    std::vector<photos::staged_photo> uploads_;  ///< whose buffers are in use
    std::unique_ptr<photos::photo_stream> stream_;
};

}  // namespace gs::train
