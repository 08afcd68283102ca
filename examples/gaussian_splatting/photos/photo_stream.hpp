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
    bool keep = false;  ///< whether the decoded photo stays in host memory

    bool is_same(const photo_request& other) const { return view == other.view && level == other.level; }
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
    /// Drops the photos that stay in host memory. Keeps photos of this size level from now on.
    void keep_level(std::size_t level);

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
        std::size_t level = 0;
    };
    using lock = std::unique_lock<std::mutex>;

    void work();
    std::shared_ptr<const kept_photo> fill(buffer& b, std::shared_ptr<const kept_photo> kept, photo& scratch);
    std::shared_ptr<const kept_photo> fill_from_planes(buffer& b,
                                                       std::shared_ptr<const kept_photo> kept) const;
    void decode(const photo_request& request, photo& full, photo& small) const;
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
    std::map<std::size_t, std::shared_ptr<const kept_photo>> kept_;  ///< by view
    std::size_t kept_level_ = 0;
    bool ends_ = false;
    std::vector<std::jthread> workers_;
};

}  // namespace gs::photos
