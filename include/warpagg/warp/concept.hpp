// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The concept `warp`.
///
/// `value_t<W, T>` holds one `T` per lane of a model `W`. It is `T` itself if each lane runs as a
/// thread or a fiber, and a SIMD value if one thread runs all lanes. Code that uses `select`
/// instead of `if` on lane values runs on every model.

#include "../core/math.hpp"
#include "../core/operation.hpp"

namespace warpagg {

/// The type that holds one `T` per lane of the warp model `W`.
template <class W, class T>
using value_t = typename W::template value<T>;

/// One flag per lane.
template <class W>
using mask_t = value_t<W, bool>;

/// A warp: `W::size` lanes, a power of two up to 32. All lanes call each operation together.
///
/// | operation | meaning |
/// | --- | --- |
/// | `lane()` | each lane's number, from 0 |
/// | `ballot(p)` | bit i is lane i's p; the same in every lane |
/// | `any(p)` | some lane's p; the same in every lane |
/// | `match(key)` | bit i of lane j's result: lanes i and j hold equal keys |
/// | `shfl(v, i)` | lane i's v; `i` may differ from lane to lane |
/// | `shfl_down(v, d)` | v of lane `lane() + d`; lanes past the end keep their own |
/// | `shfl_xor(v, d)` | v of lane `lane() ^ d` |
/// | `load(p, i, active)` | `p[i]` per active lane; inactive lanes read nothing and get T{}; i < 2^31 |
/// | `load_packed(p, i, v, active)` | `v[k] = p[i + k]`, k < 4 K; `p + i` is aligned to 4 values |
/// | `store(p, i, v, active)` | `p[i] = v` per active lane |
/// | `store_packed(p, i, v, active)` | `p[i + k] = v[k]`, likewise |
/// | `load_row(p, i, active)` | `p[i + lane]` per active lane; `i` is uniform and may be negative |
/// | `load_row(p, i)` | `p[i + lane]` in every lane |
/// | `store_row(p, i, v, active)` | `p[i + lane] = v` per active lane |
/// | `sync()` | writes of any lane before it are visible to every lane after it |
/// | `atomic(op, dst, i, v, active)` | per active lane, `*dst(i) = op::combine(*dst(i), v)`, relaxed |
template <class W>
concept warp = requires(const W& w, value_t<W, float> v, value_t<W, unsigned> i, mask_t<W> p, float* m,
                        value_t<W, float> (&packed)[4], float* (*dst)(unsigned)) {
    { W::size } -> std::convertible_to<unsigned>;
    { w.lane() } -> std::same_as<value_t<W, unsigned>>;
    { w.ballot(p) } -> std::same_as<std::uint32_t>;
    { w.any(p) } -> std::same_as<bool>;
    { w.match(i) } -> std::same_as<value_t<W, std::uint32_t>>;
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

/// The type of one lane of `V`: the `T` of a `value_t<W, T>`.
template <class V>
using scalar_t = typename detail::scalar_of<V>::type;

}  // namespace warpagg
