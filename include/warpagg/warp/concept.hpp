// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The concept `warp`.
///
/// `value_t<W, T>` holds one `T` per lane of a model `W`. It is `T` itself if each lane runs as a
/// thread or a fiber, and a SIMD value if one thread runs all lanes. Masked code, which uses
/// `select` instead of `if` on lane values, runs on every model.

#include "../core/math.hpp"
#include "../core/operation.hpp"

namespace warpagg {

/// The type that holds one `T` per lane of the warp model `W`.
template <class W, class T>
using value_t = typename W::template value<T>;

/// The type of a lane mask, which holds one flag per lane.
template <class W>
using mask_t = value_t<W, bool>;

/// One bit per lane of the warp model `W`, lane 0 in the lowest bit: an integer of 32 bits for up to 32
/// lanes, and of 64 bits for 64 lanes.
template <class W>
using lane_bits_t = std::conditional_t<(W::size > 32), std::uint64_t, std::uint32_t>;

/// A warp of `W::size` lanes, a power of two up to 64. All lanes call each operation together.
///
/// | operation | meaning |
/// | --- | --- |
/// | `lane()` | the lane's number, from 0 |
/// | `ballot(p)` | a uniform `lane_bits_t<W>` whose bit i is lane i's p |
/// | `any(p)` | whether p is set in some lane; uniform |
/// | `match(key)` | a `lane_bits_t<W>`; bit i tells whether lane i's key equals this lane's key |
/// | `shfl(v, i)` | v of lane i; `i` may differ between lanes |
/// | `shfl_down(v, d)` | v of lane `lane() + d`, or the lane's own v past the last lane |
/// | `shfl_xor(v, d)` | v of lane `lane() ^ d` |
/// | `load(p, i, active)` | `p[i]` in active lanes, T{} without a read in inactive lanes; i < 2^31 |
/// | `load_packed(p, i, v, active)` | `v[k] = p[i + k]` for k < N, N % 4 = 0; `p + i` is aligned to 4 T |
/// | `store(p, i, v, active)` | `p[i] = v` in active lanes |
/// | `store_packed(p, i, v, active)` | `p[i + k] = v[k]` in active lanes, as `load_packed` |
/// | `load_row(p, i, active)` | `p[i + lane()]` in active lanes; `i` is uniform and may be negative |
/// | `load_row(p, i)` | `p[i + lane()]` in every lane |
/// | `store_row(p, i, v, active)` | `p[i + lane()] = v` in active lanes |
/// | `sync()` | makes earlier writes of all lanes visible to all lanes |
/// | `atomic(op, dst, i, v, active)` | `*dst(i) = op::combine(*dst(i), v)` per active lane, relaxed |
template <class W>
concept warp = requires(const W& w, value_t<W, float> v, value_t<W, unsigned> i, mask_t<W> p, float* m,
                        value_t<W, float> (&packed)[4], float* (*dst)(unsigned)) {
    { W::size } -> std::convertible_to<unsigned>;
    requires(W::size > 0 && W::size <= 64 && (W::size & (W::size - 1)) == 0);
    { w.lane() } -> std::same_as<value_t<W, unsigned>>;
    { w.ballot(p) } -> std::same_as<lane_bits_t<W>>;
    { w.any(p) } -> std::same_as<bool>;
    { w.match(i) } -> std::same_as<value_t<W, lane_bits_t<W>>>;
    { w.shfl(v, 0u) } -> std::same_as<value_t<W, float>>;
    { w.shfl(v, i) } -> std::same_as<value_t<W, float>>;
    { w.shfl_down(v, 1u) } -> std::same_as<value_t<W, float>>;
    { w.shfl_xor(v, 1u) } -> std::same_as<value_t<W, float>>;
    { w.load(m, i, p) } -> std::same_as<value_t<W, float>>;
    w.load_packed(m, i, packed, p);
    w.store(m, i, v, p);
    w.store_packed(m, i, packed, p);
    { w.load_row(m, std::ptrdiff_t{}, p) } -> std::same_as<value_t<W, float>>;
    { w.load_row(m, std::ptrdiff_t{}) } -> std::same_as<value_t<W, float>>;
    w.store_row(m, std::ptrdiff_t{}, v, p);
    w.sync();
    w.atomic(operation::sum{}, dst, i, v, p);
};

namespace detail {

template <class V>
struct scalar_of {
    using type = V;
};
template <class V>
requires requires { typename V::scalar; }
struct scalar_of<V> {
    using type = typename V::scalar;
};

}  // namespace detail

/// The type of one lane's value: `T` for a `value_t<W, T>`.
template <class V>
using scalar_t = typename detail::scalar_of<V>::type;

}  // namespace warpagg
