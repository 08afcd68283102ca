// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "communicator.hpp"

#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

#include "../core/error.hpp"
#include "shared_memory.hpp"

namespace gs::ranks {

namespace {

enum operation : std::uint32_t {
    sum_of = 0,
    minimum_of = 16,
    maximum_of = 32,
    gather_of = 48,
    exchange_of = 64
};

/// Returns a number that the types of a collective function do not share.
template <class T>
constexpr std::uint32_t number_of_type() {
    return static_cast<std::uint32_t>(sizeof(T)) | (std::numeric_limits<T>::is_integer ? 1u : 0u) |
           (std::numeric_limits<T>::is_signed ? 2u : 0u);
}

}  // namespace

shared_memory::owner shared_memory::make() {
    void* const memory = mmap(nullptr, sizeof(shared_memory), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw error("cannot share memory between ranks: give fewer --ranks");
    return owner(static_cast<shared_memory*>(memory));
}

void shared_memory::unmap::operator()(shared_memory* memory) const { munmap(memory, sizeof(shared_memory)); }

void communicator::barrier() {
    if (count_ == 1) return;
    const std::uint64_t all = ++barriers_ * static_cast<std::uint64_t>(count_);
    memory_->arrived.fetch_add(1);
    // Waits briefly without a system call, because ranks arrive at about the same time, and then
    // leaves the processor to others.
    constexpr int spins = 2000, yields = 200;
    for (int tries = 0; memory_->arrived.load() < all; ++tries) {
        if (tries < spins) continue;
        if (memory_->has_ended.load()) throw peer_ended();
        if (tries < spins + yields)
            sched_yield();
        else
            usleep(50);
    }
}

template <class Take>
void communicator::show(std::uint32_t operation, std::size_t size, const void* bytes, std::size_t count,
                        const Take& take) {
    const std::size_t which = exchanges_++ % 2;
    shared_memory::slot& own = memory_->slots[static_cast<std::size_t>(rank_)][which];
    own.values = size;
    own.operation = operation;
    if (count > 0) std::memcpy(own.bytes, bytes, count);
    barrier();
    for (int r = 0; r < count_; ++r) {
        const shared_memory::slot& other = memory_->slots[static_cast<std::size_t>(r)][which];
        if (other.values != own.values || other.operation != own.operation)
            throw std::logic_error("ranks " + std::to_string(rank_) + " and " + std::to_string(r) +
                                   " disagree about their next exchange");
        take(r, other.bytes);
    }
}

template <class T, class Combine>
void communicator::reduce(std::uint32_t operation, T* values, std::size_t n, const Combine& combine) {
    if (count_ == 1) return;
    constexpr std::size_t at_once = shared_memory::slot_bytes / sizeof(T);
    for (std::size_t first = 0; first < n || first == 0; first += at_once) {
        const std::size_t size = std::min(at_once, n - first);
        T* const part = values + first;
        show(operation | number_of_type<T>(), n, part, size * sizeof(T), [&](int r, const std::byte* bytes) {
            const T* const theirs = reinterpret_cast<const T*>(bytes);
            if (r == 0)
                std::copy_n(theirs, size, part);
            else
                for (std::size_t i = 0; i < size; ++i) part[i] = combine(part[i], theirs[i]);
        });
    }
}

void communicator::gather(const shares& all, std::span<const shared_array> arrays) {
    if (count_ == 1) return;
    traffic_.count_gather(all, arrays);
    for (const shared_array& array : arrays) gather(all, array);
}

void communicator::gather(const shares& all, const shared_array& array) {
    constexpr std::size_t at_once = shared_memory::slot_bytes;
    std::size_t longest = 0;
    for (int r = 0; r < count_; ++r) longest = std::max(longest, array.part(all, r).size());
    const auto piece = [&](int rank, std::size_t first) {
        const auto part = array.part(all, rank);
        return part.subspan(std::min(first, part.size()),
                            std::min(at_once, part.size() - std::min(first, part.size())));
    };
    for (std::size_t first = 0; first < longest; first += at_once) {
        const auto own = piece(rank_, first);
        show(gather_of, array.bytes, own.data(), own.size(), [&](int r, const std::byte* bytes) {
            if (r == rank_) return;
            std::copy_n(bytes, piece(r, first).size(), piece(r, first).begin());
        });
    }
}

void communicator::exchange(const windows& all, std::span<const window_array> arrays) {
    if (count_ == 1) return;
    traffic_.count_exchange(all, arrays);
    for (const window_array& array : arrays) exchange(all, array);
}

void communicator::exchange(const windows& all, const window_array& array) {
    constexpr std::size_t at_once = shared_memory::slot_bytes;
    std::size_t longest = 0;
    for (int r = 0; r < count_; ++r) longest = std::max(longest, all.sent_by(r).items() * array.item_bytes);
    for (std::size_t first = 0; first < longest; first += at_once) {
        const std::size_t own = all.sent_by(rank_).items() * array.item_bytes;
        const std::size_t begin = std::min(first, own), end = std::min(first + at_once, own);
        show(exchange_of, longest, array.from + begin, end - begin, [&](int r, const std::byte* bytes) {
            if (r == rank_) return;
            // The part of the window to this rank that lies in the piece which rank r shows.
            const share items = all.sent_by(r).of(rank_);
            const std::size_t from = std::max(items.first * array.item_bytes, first);
            const std::size_t to = std::min(items.last * array.item_bytes, first + at_once);
            if (from >= to) return;
            const std::size_t before = from - items.first * array.item_bytes;
            std::copy_n(bytes + (from - first), to - from,
                        array.received(all, r, rank_).begin() + static_cast<std::ptrdiff_t>(before));
        });
    }
}

template <class T>
void communicator::sum(T* values, std::size_t n) {
    traffic_.count_sum(n * sizeof(T));
    reduce(sum_of, values, n, [](T a, T b) { return a + b; });
}
template <class T>
void communicator::minimum(T* values, std::size_t n) {
    traffic_.count_sum(n * sizeof(T));
    reduce(minimum_of, values, n, [](T a, T b) { return std::min(a, b); });
}
template <class T>
void communicator::maximum(T* values, std::size_t n) {
    traffic_.count_sum(n * sizeof(T));
    reduce(maximum_of, values, n, [](T a, T b) { return std::max(a, b); });
}

double communicator::from_first(double value) {
    if (!is_first()) value = 0;
    sum(&value, 1);
    return value;
}

bool communicator::any(bool flag) {
    std::uint64_t flags = flag ? 1 : 0;
    maximum(&flags, 1);
    return flags != 0;
}

template void communicator::sum(float*, std::size_t);
template void communicator::sum(double*, std::size_t);
template void communicator::sum(std::int64_t*, std::size_t);
template void communicator::sum(std::uint64_t*, std::size_t);
template void communicator::minimum(std::uint64_t*, std::size_t);
template void communicator::minimum(unsigned long long*, std::size_t);
template void communicator::maximum(std::uint64_t*, std::size_t);
template void communicator::maximum(unsigned long long*, std::size_t);

}  // namespace gs::ranks
