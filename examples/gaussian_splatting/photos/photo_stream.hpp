// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "../scene/scene.hpp"

namespace gs::photos {

/// A photo that training will need: a view, halved `level` times.
struct photo_request {
    std::size_t view = 0;
    std::size_t level = 0;

    bool operator==(const photo_request&) const = default;
    auto operator<=>(const photo_request&) const = default;
};

/// The size levels from `first` up to, but without, `end`.
struct level_range {
    std::size_t first = 0;
    std::size_t end = 0;

    bool has(std::size_t level) const { return first <= level && level < end; }
    /// Adds a level below all others. Returns false if there is a gap.
    bool extend_to(std::size_t level) {
        if (first == end) *this = {level + 1, level + 1};
        if (first != level + 1) return false;
        first = level;
        return true;
    }
};

/// A packed photo in host memory: see `pack`.
struct staged_photo {
    std::uint8_t* bytes = nullptr;
    std::size_t number = 0;  ///< index of its buffer
    photo_request of;
    bool has_mask = false;
    bool has_depths = false;
};

/// Threads that decode photos in the order in which training will need them, each into a buffer of
/// the caller. The functions are for one thread.
class photo_stream {
  public:
    /// Starts the threads. The buffers must outlive the object; each has room for the largest packed
    /// photo. `views` are numbered in their order, and are all streamed.
    photo_stream(std::vector<view> views, std::size_t workers, const std::vector<std::uint8_t*>& buffers);
    photo_stream(const photo_stream&) = delete;
    photo_stream& operator=(const photo_stream&) = delete;
    /// Waits for photos that are being decoded.
    ~photo_stream();

    /// Replaces the list of photos to decode. The first ones are needed first. Decoded photos that are
    /// not in the list are dropped.
    void expect(std::vector<photo_request> next);
    /// Returns whether `take` would neither wait nor throw.
    bool is_ready(const photo_request& request);
    /// Returns a photo and its buffer, which stays with the caller until `release`. Waits until the
    /// photo is decoded. Throws the exception of `view::decode`. Precondition: not all buffers are
    /// with the caller.
    const staged_photo& take(const photo_request& request);
    /// Returns the exception that `take` would throw, or null. Waits like `take`.
    std::exception_ptr failure_of(const photo_request& request);
    void release(const staged_photo& photo);
    /// Sets which photos stay in host memory once their view is decoded, by view. Drops all others there.
    void keep(std::vector<level_range> kept);

  private:
    enum class state { empty, decoding, ready, taken };
    struct buffer {
        staged_photo photo;
        photo_stream::state state = photo_stream::state::empty;
        std::exception_ptr failure;
    };
    /// A photo in host memory: its samples if the view has `read_planes` and the size is the full one.
    struct kept_photo {
        photo decoded;
        jpeg_planes planes;
    };
    using kept_photos = std::map<photo_request, std::shared_ptr<const kept_photo>>;
    using lock = std::unique_lock<std::mutex>;

    void work();
    kept_photos fill(buffer& b, std::shared_ptr<const kept_photo> kept, level_range to_keep,
                     photo& scratch) const;
    kept_photos read(const photo_request& request, level_range to_keep, photo& scratch) const;
    void drop_unwanted(kept_photos& photos) const;
    buffer* find(const photo_request& request);
    buffer* find_empty();
    const photo_request* next_request();
    buffer& wait_for(lock& locked, const photo_request& request);
    bool is_expected(const photo_request& request) const;

    const std::vector<view> views_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<buffer> buffers_;
    std::deque<photo_request> expected_;
    kept_photos kept_;
    std::vector<level_range> levels_to_keep_;  ///< by view
    bool ends_ = false;
    std::vector<std::jthread> workers_;
};

}  // namespace gs::photos
