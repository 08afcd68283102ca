// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace gs::device {

/// What a candidate is worth that comes to nothing.
inline constexpr std::uint32_t no_bucket = 0xffffffffu;

/// Items that go to any number of buckets: what a device's `distribute` takes. Of `items(i)`
///
/// | | |
/// | --- | --- |
/// | `size()` | how many candidates it has, buckets that it may go to |
/// | `bucket(k)` | candidate k, or `no_bucket` if it does not go there; the same whenever it is asked, and no
/// bucket twice | | `value` | what stands for it in the lists |
template <class T>
concept items = requires(const T& all, std::size_t i, std::uint32_t k) {
    { all(i).size() } -> std::same_as<std::uint32_t>;
    { all(i).bucket(k) } -> std::same_as<std::uint32_t>;
    { all(i).value } -> std::convertible_to<std::uint32_t>;
};

}  // namespace gs::device
