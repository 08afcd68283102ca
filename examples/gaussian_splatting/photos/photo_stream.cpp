// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "photo_stream.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "../scene/downsample.hpp"
#include "../scene/view_photo.hpp"
#include "packed_photo.hpp"

namespace gs::photos {

photo_stream::photo_stream(std::vector<view> views, std::size_t workers,
                           const std::vector<std::uint8_t*>& buffers)
    : views_(std::move(views)) {
    for (std::uint8_t* bytes : buffers) {
        buffers_.emplace_back();
        buffers_.back().photo.bytes = bytes;
        buffers_.back().photo.number = buffers_.size() - 1;
    }
    try {
        for (std::size_t i = 0; i < workers; ++i) workers_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {  // the system allows no more threads
        if (workers_.empty()) throw;
    }
}

photo_stream::~photo_stream() {
    {
        const lock locked(mutex_);
        ends_ = true;
    }
    changed_.notify_all();
}

void photo_stream::expect(std::vector<photo_request> next) {
    {
        const lock locked(mutex_);
        expected_.assign(next.begin(), next.end());
        for (buffer& b : buffers_)
            if (b.state == state::ready && !is_expected(b.photo.of)) b.state = state::empty;
    }
    changed_.notify_all();
}

bool photo_stream::is_ready(const photo_request& request) {
    const lock locked(mutex_);
    const buffer* found = find(request);
    return found != nullptr && found->state == state::ready && !found->failure;
}

const staged_photo& photo_stream::take(const photo_request& request) {
    lock locked(mutex_);
    buffer& found = wait_for(locked, request);
    const auto first = std::ranges::find_if(expected_, [&](const auto& r) { return r.is_same(request); });
    if (first != expected_.end()) expected_.erase(first);
    if (found.failure) {
        found.state = state::empty;
        std::rethrow_exception(std::exchange(found.failure, nullptr));
    }
    found.state = state::taken;
    return found.photo;
}

std::exception_ptr photo_stream::failure_of(const photo_request& request) {
    lock locked(mutex_);
    return wait_for(locked, request).failure;
}

void photo_stream::release(const staged_photo& photo) {
    {
        const lock locked(mutex_);
        buffers_[photo.number].state = state::empty;
    }
    changed_.notify_all();
}

void photo_stream::keep_level(std::size_t level) {
    const lock locked(mutex_);
    kept_level_ = level;
    kept_.clear();
}

/// Waits until a photo is decoded. If it was not expected, it is decoded next, in place of the
/// decoded photo that is needed last.
photo_stream::buffer& photo_stream::wait_for(lock& locked, const photo_request& request) {
    buffer* found = find(request);
    if (found == nullptr) {
        std::erase_if(expected_, [&](const photo_request& r) { return r.is_same(request); });
        expected_.push_front(request);
        changed_.notify_all();
    } else if (!is_expected(request)) {
        expected_.push_front(request);
    }
    const auto is_decoded = [&] {
        found = find(request);
        if (found != nullptr) return found->state == state::ready;
        if (find_empty() != nullptr) return false;
        for (auto last = expected_.rbegin(); last != expected_.rend(); ++last)
            if (buffer* b = find(*last); b != nullptr && b->state == state::ready) {
                b->state = state::empty;
                changed_.notify_all();
                break;
            }
        return false;
    };
    changed_.wait(locked, is_decoded);
    return *found;
}

void photo_stream::work() {
    photo scratch;
    lock locked(mutex_);
    while (true) {
        buffer* empty = nullptr;
        const photo_request* next = nullptr;
        changed_.wait(locked, [&] {
            empty = find_empty();
            next = next_request();
            return ends_ || (empty != nullptr && next != nullptr);
        });
        if (ends_) return;
        empty->state = state::decoding;
        empty->photo.of = *next;
        empty->failure = nullptr;
        const auto found = kept_.find(empty->photo.of.view);
        std::shared_ptr<const kept_photo> kept = found == kept_.end() ? nullptr : found->second;
        if (kept != nullptr && kept->level != empty->photo.of.level) kept = nullptr;
        locked.unlock();
        kept = fill(*empty, std::move(kept), scratch);
        locked.lock();
        if (kept != nullptr && kept->level == kept_level_) kept_[empty->photo.of.view] = std::move(kept);
        empty->state = is_expected(empty->photo.of) ? state::ready : state::empty;
        changed_.notify_all();
    }
}

/// Copies a kept photo to the buffer, or decodes it. Returns the decoded photo if the request asks to
/// keep it. Reuses the memory of `scratch`, because fresh memory costs as much time
/// as decoding. Runs without the lock.
std::shared_ptr<const photo_stream::kept_photo> photo_stream::fill(buffer& b,
                                                                   std::shared_ptr<const kept_photo> kept,
                                                                   photo& scratch) {
    const photo_request& request = b.photo.of;
    if (request.level == 0 && views_[request.view].read_planes && (request.keep || kept != nullptr))
        return fill_from_planes(b, std::move(kept));
    photo small;
    if (kept == nullptr) try {
            decode(request, scratch, small);
        } catch (...) {
            b.failure = std::current_exception();
            return nullptr;
        }
    photo& decoded = request.level > 0 ? small : scratch;
    const photo& found = kept != nullptr ? kept->decoded : decoded;
    pack(found.pixels, found.depths, b.photo.bytes);
    b.photo.has_mask = found.pixels.has_mask;
    b.photo.has_depths = found.depths.is_there();
    if (!request.keep || kept != nullptr) return nullptr;
    return std::make_shared<const kept_photo>(kept_photo{std::move(decoded), {}, request.level});
}

/// Like `fill`, for a photo that stays in host memory as the samples of its file.
std::shared_ptr<const photo_stream::kept_photo> photo_stream::fill_from_planes(
    buffer& b, std::shared_ptr<const kept_photo> kept) const {
    std::shared_ptr<kept_photo> read;
    if (kept == nullptr) try {
            kept = read = std::make_shared<kept_photo>();
            views_[b.photo.of.view].read_planes(read->planes);
        } catch (...) {
            b.failure = std::current_exception();
            return nullptr;
        }
    to_rgba(kept->planes, b.photo.bytes);
    b.photo.has_mask = b.photo.has_depths = false;
    return read;
}

/// Decodes a photo into `full`, and into `small` if the request asks for a smaller size.
void photo_stream::decode(const photo_request& request, photo& full, photo& small) const {
    const view& of = views_[request.view];
    gs::decode(of, full);
    if (request.level == 0) return;
    const camera size = downsampled(of.camera, 1 << request.level);
    small.pixels = downsample(full.pixels, size.width, size.height);
    small.depths = resized(full.depths, size.width, size.height);
}

photo_stream::buffer* photo_stream::find(const photo_request& request) {
    const auto found = std::ranges::find_if(buffers_, [&](const buffer& b) {
        return (b.state == state::decoding || b.state == state::ready) && b.photo.of.is_same(request);
    });
    return found == buffers_.end() ? nullptr : &*found;
}

photo_stream::buffer* photo_stream::find_empty() {
    const auto found = std::ranges::find(buffers_, state::empty, &buffer::state);
    return found == buffers_.end() ? nullptr : &*found;
}

/// Returns the first expected photo without a buffer, or null.
const photo_request* photo_stream::next_request() {
    const auto next = std::ranges::find_if(expected_, [&](const auto& r) { return find(r) == nullptr; });
    return next == expected_.end() ? nullptr : &*next;
}

bool photo_stream::is_expected(const photo_request& request) const {
    return std::ranges::any_of(expected_, [&](const auto& r) { return r.is_same(request); });
}

}  // namespace gs::photos
