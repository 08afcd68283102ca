// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "communicator.hpp"

#include <algorithm>
#include <limits>

namespace gs::ranks {

namespace {

enum operation : std::uint64_t {
    sum_of = 0,
    minimum_of = 16,
    maximum_of = 32,
    gather_of = 48,
    exchange_of = 64,
    barrier_of = 80
};

/// Returns a number that the types of a collective function do not share.
template <class T>
constexpr std::uint64_t number_of_type() {
    return std::uint64_t{sizeof(T)} | (std::numeric_limits<T>::is_integer ? 1u : 0u) |
           (std::numeric_limits<T>::is_signed ? 2u : 0u);
}

}  // namespace

void communicator::barrier() {
    if (count() > 1) transport_->show({0, barrier_of}, {});
}

template <class T, class Combine>
void communicator::reduce(std::uint64_t operation, T* values, std::size_t n, const Combine& combine) {
    if (count() == 1) return;
    constexpr std::size_t at_once = transport::most_bytes / sizeof(T);
    for (std::size_t first = 0; first < n || first == 0; first += at_once) {
        const std::size_t size = std::min(at_once, n - first);
        T* const part = values + first;
        const auto shown = transport_->show({n, operation | number_of_type<T>()},
                                            std::as_bytes(std::span<const T>(part, size)));
        std::copy_n(reinterpret_cast<const T*>(shown[0].data()), size, part);
        for (const transport::bytes bytes : shown.subspan(1)) {
            const T* const theirs = reinterpret_cast<const T*>(bytes.data());
            for (std::size_t i = 0; i < size; ++i) part[i] = combine(part[i], theirs[i]);
        }
    }
}

void communicator::gather(const shares& all, std::span<const shared_array> arrays) {
    if (count() == 1) return;
    traffic_.count_gather(all, arrays);
    for (const shared_array& array : arrays) gather(all, array);
}

void communicator::gather(const shares& all, const shared_array& array) {
    constexpr std::size_t at_once = transport::most_bytes;
    std::size_t longest = 0;
    for (int r = 0; r < count(); ++r) longest = std::max(longest, array.part(all, r).size());
    const auto piece = [&](int rank, std::size_t first) {
        const auto part = array.part(all, rank);
        return part.subspan(std::min(first, part.size()),
                            std::min(at_once, part.size() - std::min(first, part.size())));
    };
    for (std::size_t first = 0; first < longest; first += at_once) {
        const auto shown = transport_->show({array.bytes, gather_of}, piece(rank(), first));
        for (int r = 0; r < count(); ++r) {
            const auto theirs = shown[static_cast<std::size_t>(r)];
            if (theirs.size() != piece(r, first).size()) throw disagreement(rank(), r);
            if (r != rank()) std::ranges::copy(theirs, piece(r, first).begin());
        }
    }
}

void communicator::exchange(const windows& all, std::span<const window_array> arrays) {
    if (count() == 1) return;
    traffic_.count_exchange(all, arrays);
    for (const window_array& array : arrays) exchange(all, array);
}

void communicator::exchange(const windows& all, const window_array& array) {
    constexpr std::size_t at_once = transport::most_bytes;
    std::size_t longest = 0;
    for (int r = 0; r < count(); ++r) longest = std::max(longest, all.sent_by(r).items() * array.item_bytes);
    for (std::size_t first = 0; first < longest; first += at_once) {
        const std::size_t own = all.sent_by(rank()).items() * array.item_bytes;
        const std::size_t begin = std::min(first, own), end = std::min(first + at_once, own);
        const auto shown = transport_->show({longest, exchange_of}, {array.from + begin, end - begin});
        for (int r = 0; r < count(); ++r) {
            if (r == rank()) continue;
            const auto theirs = shown[static_cast<std::size_t>(r)];
            // The part of the window to this rank that lies in the piece which rank r shows.
            const share items = all.sent_by(r).of(rank());
            const std::size_t from = std::max(items.first * array.item_bytes, first);
            const std::size_t to = std::min(items.last * array.item_bytes, first + at_once);
            if (from >= to) continue;
            if (to - first > theirs.size()) throw disagreement(rank(), r);
            const std::size_t before = from - items.first * array.item_bytes;
            std::ranges::copy(theirs.subspan(from - first, to - from),
                              array.received(all, r, rank()).subspan(before).begin());
        }
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
