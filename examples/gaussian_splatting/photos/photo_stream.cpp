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
namespace {

/// Halves the full size of a photo `level` times.
photo halved(const view& of, const photo& full, std::size_t level) {
    const camera size = downsampled(of.camera, 1 << level);
    return {downsample(full.pixels, size.width, size.height), resized(full.depths, size.width, size.height)};
}

}  // namespace

photo_stream::photo_stream(std::vector<view> views, std::size_t workers,
                           const std::vector<std::uint8_t*>& buffers)
    : views_(std::move(views)), levels_to_keep_(views_.size()) {
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
    const auto first = std::ranges::find_if(expected_, [&](const auto& r) { return r == request; });
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

void photo_stream::keep(std::vector<level_range> kept) {
    const lock locked(mutex_);
    levels_to_keep_ = std::move(kept);
    drop_unwanted(kept_);
}

void photo_stream::drop_unwanted(kept_photos& photos) const {
    std::erase_if(photos, [&](const auto& p) { return !levels_to_keep_[p.first.view].has(p.first.level); });
}

/// Waits until a photo is decoded. If it was not expected, it is decoded next, in place of the
/// decoded photo that is needed last.
photo_stream::buffer& photo_stream::wait_for(lock& locked, const photo_request& request) {
    buffer* found = find(request);
    if (found == nullptr) {
        std::erase_if(expected_, [&](const photo_request& r) { return r == request; });
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
        const auto found = kept_.find(*next);
        const std::shared_ptr<const kept_photo> kept = found == kept_.end() ? nullptr : found->second;
        const level_range to_keep = levels_to_keep_[next->view];
        locked.unlock();
        kept_photos made = fill(*empty, kept, to_keep, scratch);
        locked.lock();
        drop_unwanted(made);
        kept_.merge(made);
        empty->state = is_expected(empty->photo.of) ? state::ready : state::empty;
        changed_.notify_all();
    }
}

/// Copies a kept photo to the buffer, or decodes it and returns the sizes to keep. Runs without the
/// lock.
photo_stream::kept_photos photo_stream::fill(buffer& b, std::shared_ptr<const kept_photo> kept,
                                             level_range to_keep, photo& scratch) const {
    kept_photos made;
    try {
        if (kept == nullptr) {
            made = read(b.photo.of, to_keep, scratch);
            if (const auto found = made.find(b.photo.of); found != made.end()) kept = found->second;
        }
        if (kept != nullptr && !kept->planes.samples.empty()) {
            to_rgba(kept->planes, b.photo.bytes);
            b.photo.has_mask = b.photo.has_depths = false;
            return made;
        }
        const photo& found = kept != nullptr ? kept->decoded : scratch;
        pack(found.pixels, found.depths, b.photo.bytes);
        b.photo.has_mask = found.pixels.has_mask;
        b.photo.has_depths = found.depths.is_there();
    } catch (...) {
        b.failure = std::current_exception();
    }
    return made;
}

/// Reads the requested size of a view and those to keep. Returns them, but leaves the full size in
/// `scratch` if it is requested and not kept. Reuses the memory of `scratch`, because fresh memory costs
/// as much time as decoding. Runs without the lock.
photo_stream::kept_photos photo_stream::read(const photo_request& request, level_range to_keep,
                                             photo& scratch) const {
    const view& of = views_[request.view];
    kept_photos made;
    const auto make = [&](std::size_t level) -> kept_photo& {
        const auto kept = std::make_shared<kept_photo>();
        made.emplace(photo_request{request.view, level}, kept);
        return *kept;
    };
    const bool reads_planes = of.read_planes && to_keep.has(0);
    if (!reads_planes || request.level > 0 || to_keep.end > 1) gs::decode(of, scratch);
    for (std::size_t level = std::max(to_keep.end, request.level + 1); --level > 0;)
        if (to_keep.has(level) || level == request.level) make(level).decoded = halved(of, scratch, level);
    if (reads_planes)
        of.read_planes(make(0).planes);
    else if (to_keep.has(0))
        make(0).decoded = std::move(scratch);
    return made;
}

photo_stream::buffer* photo_stream::find(const photo_request& request) {
    const auto found = std::ranges::find_if(buffers_, [&](const buffer& b) {
        return (b.state == state::decoding || b.state == state::ready) && b.photo.of == request;
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
    return std::ranges::any_of(expected_, [&](const auto& r) { return r == request; });
}

}  // namespace gs::photos
