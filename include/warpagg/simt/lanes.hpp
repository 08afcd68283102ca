// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <utility>

#include "atomic_memory.hpp"
#include "counters.hpp"
#include "simd.hpp"

namespace warpagg::emulator {

/// Counts nothing and costs nothing.
struct uncounted {
    static constexpr bool counts = false;  ///< whether there is something to add to
};

/// Adds what the warp does to `*to`. One thread at a time.
struct counted {
    static constexpr bool counts = true;  ///< whether there is something to add to
    counters* to;                         ///< what is added to
};

/// The fast emulator: one thread runs a warp of 32 lanes, all of them in SIMD registers. Lane values are
/// `warpagg::lanes<T, 32>`, so kernels are masked (`select`, uniform branches). Lanes commit in order of
/// their number.
template <class Counting>
struct basic_lanes : Counting {
    /// The operation of this name of the concept `warp`.
    /// @{
    static constexpr unsigned size = 32;
    template <class T>
    using value = warpagg::lanes<T, 32>;
    using mask = value<bool>;

    WARPAGG_HD value<unsigned> lane() const {
        value<unsigned> r;
        WARPAGG_UNROLL
        for (int i = 0; i < 32; ++i) r.set(i, static_cast<unsigned>(i));
        return r;
    }

    WARPAGG_HD std::uint32_t ballot(const mask& p) const {
        count([](counters& c) { ++c.votes; });
        return bits(p);
    }
    WARPAGG_HD bool any(const mask& p) const {
        count([](counters& c) { ++c.votes; });
        return bits(p) != 0;
    }

    template <class T>
    WARPAGG_HD value<T> shfl(const value<T>& v, unsigned from) const {
        count_shuffle<T>();
        return value<T>(v[static_cast<int>(from % size)]);
    }
    template <class T>
    WARPAGG_HD value<T> shfl(const value<T>& v, const value<unsigned>& from) const {
        count_shuffle<T>();
        value<T> r;
        WARPAGG_UNROLL
        for (int i = 0; i < 32; ++i) r.set(i, v[static_cast<int>(from[i] % size)]);
        return r;
    }
    WARPAGG_HD value<std::uint32_t> match(const value<unsigned>& key) const {
        count([](counters& c) { ++c.votes; });
        value<std::uint32_t> r;
        WARPAGG_UNROLL
        for (int i = 0; i < 32; ++i) r.set(i, bits(key == value<unsigned>(key[i])));
        return r;
    }
    template <class T>
    WARPAGG_HD value<T> shfl_down(const value<T>& v, unsigned distance) const {
        count_shuffle<T>();
        switch (distance) {
            case 16:
                return down<16>(v);
            case 8:
                return down<8>(v);
            case 4:
                return down<4>(v);
            case 2:
                return down<2>(v);
            case 1:
                return down<1>(v);
            default: {
                value<T> r = v;
                WARPAGG_UNROLL
                for (unsigned i = 0; i + distance < size; ++i)
                    r.set(static_cast<int>(i), v[static_cast<int>(i + distance)]);
                return r;
            }
        }
    }
    template <class T>
    WARPAGG_HD value<T> shfl_xor(const value<T>& v, unsigned distance) const {
        count_shuffle<T>();
        switch (distance) {
            case 16:
                return across<16>(v);
            case 8:
                return across<8>(v);
            case 4:
                return across<4>(v);
            case 2:
                return across<2>(v);
            case 1:
                return across<1>(v);
            default: {
                value<T> r;
                WARPAGG_UNROLL
                for (unsigned i = 0; i < size; ++i)
                    r.set(static_cast<int>(i), v[static_cast<int>((i ^ distance) % size)]);
                return r;
            }
        }
    }

    template <class T>
    WARPAGG_HD value<T> load(const T* from, const value<unsigned>& index, const mask& active) const {
        value<T> r;
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i) {
#if defined(__AVX2__)
            if constexpr (sizeof(T) == 4 && !std::is_same_v<T, bool>) {
                r.part[i] = reinterpret_cast<typename value<T>::chunk>(_mm256_mask_i32gather_epi32(
                    __m256i{}, reinterpret_cast<const int*>(from), reinterpret_cast<__m256i>(index.part[i]),
                    reinterpret_cast<__m256i>(active.part[i]), 4));
                continue;
            }
#endif
            WARPAGG_UNROLL
            for (int k = i * r.width; k < (i + 1) * r.width; ++k) r.set(k, active[k] ? from[index[k]] : T{});
        }
        return r;
    }
    template <class T, int N>
    WARPAGG_HD void load_packed(const T* from, const value<unsigned>& index, value<T> (&v)[N],
                                const mask& active) const {
        for (unsigned k = 0; k < N; ++k) v[k] = load(from + k, index, active);
    }
    template <class T>
    WARPAGG_HD void store(T* to, const value<unsigned>& index, const value<T>& v, const mask& active) const {
        for_each_lane(bits(active), [&](int lane) { to[index[lane]] = v[lane]; });
    }
    template <class T, int N>
    WARPAGG_HD void store_packed(T* to, const value<unsigned>& index, const value<T> (&v)[N],
                                 const mask& active) const {
        for (unsigned k = 0; k < N; ++k) store(to + k, index, v[k], active);
    }
    WARPAGG_HD void sync() const {}
    template <class T>
    WARPAGG_HD value<T> load_row(const T* from, std::ptrdiff_t first, const mask& active) const {
        value<T> r;
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i) {
            const T* p = from + first + i * r.width;
#if defined(__AVX2__)
            if constexpr (sizeof(T) == 4) {
                r.part[i] = reinterpret_cast<typename value<T>::chunk>(_mm256_maskload_epi32(
                    reinterpret_cast<const int*>(p), reinterpret_cast<__m256i>(active.part[i])));
                continue;
            }
#endif
            WARPAGG_UNROLL
            for (int k = 0; k < r.width; ++k) r.set(i * r.width + k, active[i * r.width + k] ? p[k] : T{});
        }
        return r;
    }
    template <class T>
    WARPAGG_HD void store_row(T* to, std::ptrdiff_t first, const value<T>& v, const mask& active) const {
        WARPAGG_UNROLL
        for (int i = 0; i < v.chunks; ++i) {
            T* p = to + first + i * v.width;
#if defined(__AVX2__)
            if constexpr (sizeof(T) == 4) {
                _mm256_maskstore_epi32(reinterpret_cast<int*>(p), reinterpret_cast<__m256i>(active.part[i]),
                                       reinterpret_cast<__m256i>(v.part[i]));
                continue;
            }
#endif
            WARPAGG_UNROLL
            for (int k = 0; k < v.width; ++k)
                if (active[i * v.width + k]) p[k] = v[i * v.width + k];
        }
    }
    template <class Op, class Dst, class T>
    WARPAGG_HD void atomic(Op op, Dst dst, const value<unsigned>& index, const value<T>& v,
                           const mask& active) const {
        const std::uint32_t who = bits(active);
        count([&](counters& c) { count_commit(c, dst, index, who); });
        for_each_lane(who, [&](int lane) { detail::atomic(op, dst(index[lane]), v[lane]); });
    }

    /// @}

    /// `warp_reduce_atomic` tells how many lanes it was called with.
    WARPAGG_HD void observe(const mask& active) const requires(Counting::counts) {
        ++this->to->active[static_cast<std::size_t>(std::popcount(bits(active)))];
    }

  private:
    template <class F>
    WARPAGG_HD void count(F f) const {
        if constexpr (Counting::counts) f(*this->to);
    }
    template <class T>
    WARPAGG_HD void count_shuffle() const {
        count([](counters& c) { c.shuffles += (sizeof(T) + 3) / 4; });
    }
    template <class Dst>
    static void count_commit(counters& c, Dst dst, const value<unsigned>& index, std::uint32_t who) {
        if (who == 0) return;
        ++c.commits;
        std::uintptr_t sectors[size];
        unsigned known = 0;
        for_each_lane(who, [&](int lane) {
            ++c.atomics;
            const auto sector = reinterpret_cast<std::uintptr_t>(dst(index[lane])) / 32;
            unsigned i = 0;
            while (i < known && sectors[i] != sector) ++i;
            if (i == known) sectors[known++] = sector;
        });
        c.sectors += known;
    }

    static WARPAGG_HD std::uint32_t bits(const mask& p) {
        std::uint32_t r = 0;
#if defined(__AVX__)
        WARPAGG_UNROLL
        for (int i = 0; i < p.chunks; ++i)
            r |= static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(p.part[i])))
                 << (i * p.width);
#else
        typename mask::element flags[size];  // subscripts of vectors go astray in GCC 12 with sanitizers
        static_assert(sizeof flags == sizeof p.part);
        std::memcpy(flags, p.part, sizeof flags);
        WARPAGG_UNROLL
        for (unsigned i = 0; i < size; ++i) r |= (flags[i] != 0 ? 1u : 0u) << i;
#endif
        return r;
    }
    template <class F>
    static WARPAGG_HD void for_each_lane(std::uint32_t who, F f) {
        for (; who != 0; who &= who - 1) f(std::countr_zero(who));
    }

    template <unsigned D, class T>
    static WARPAGG_HD value<T> down(const value<T>& v) {
        constexpr int width = value<T>::width, chunks = value<T>::chunks, d = static_cast<int>(D);
        value<T> r;
        WARPAGG_UNROLL
        for (int i = 0; i < chunks; ++i) {
            if constexpr (d >= width) {
                constexpr int step = d / width;
                r.part[i] = v.part[i + step < chunks ? i + step : i];
            } else {
                [&]<std::size_t... I>(std::index_sequence<I...>) {
                    if (i + 1 < chunks) {
                        r.part[i] =
                            __builtin_shufflevector(v.part[i], v.part[i + 1], (static_cast<int>(I) + d)...);
                    } else {
                        r.part[i] = __builtin_shufflevector(
                            v.part[i], v.part[i],
                            (static_cast<int>(I) + d < width ? static_cast<int>(I) + d
                                                             : static_cast<int>(I))...);
                    }
                }
                (std::make_index_sequence<static_cast<std::size_t>(width)>{});
            }
        }
        return r;
    }
    template <unsigned D, class T>
    static WARPAGG_HD value<T> across(const value<T>& v) {
        constexpr int width = value<T>::width, d = static_cast<int>(D);
        value<T> r;
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i) {
            if constexpr (d >= width) {
                r.part[i] = v.part[i ^ (d / width)];
            } else {
                [&]<std::size_t... I>(std::index_sequence<I...>) {
                    r.part[i] = __builtin_shufflevector(v.part[i], v.part[i], (static_cast<int>(I) ^ d)...);
                }
                (std::make_index_sequence<static_cast<std::size_t>(width)>{});
            }
        }
        return r;
    }
};

/// The fast emulator, for work.
using lanes = basic_lanes<uncounted>;
/// The same, which counts what it does: `counted_lanes{{&counters}}`.
using counted_lanes = basic_lanes<counted>;

static_assert(warpagg::warp<lanes> && warpagg::warp<counted_lanes>);

}  // namespace warpagg::emulator
