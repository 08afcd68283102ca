// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace gs::device {

/// The bucket of a candidate that goes to no list.
inline constexpr std::uint32_t no_bucket = 0xffffffffu;

/// Items, each of which goes to any number of buckets: the input of `place_lists` and
/// `write_lists`, see `device`.
/// Item i is `all(i)`, with the members:
/// - `size()`: number of its candidates.
/// - `bucket(k)`: bucket of candidate k, or `no_bucket`. Depends only on i and k. The candidates of
///   an item have different buckets.
/// - `value`: represents the item in the lists.
template <class T>
concept items = requires(const T& all, std::size_t i, std::uint32_t k) {
    { all(i).size() } -> std::same_as<std::uint32_t>;
    { all(i).bucket(k) } -> std::same_as<std::uint32_t>;
    { all(i).value } -> std::convertible_to<std::uint32_t>;
};

}  // namespace gs::device
