// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <utility>

#include "../core/atomic_memory.hpp"
#include "../core/counters.hpp"
#include "simd_value.hpp"

namespace warpagg::emulator {

/// Counts no operations, at no cost.
struct uncounted {
    static constexpr bool counts = false;  ///< whether operations are counted
};

/// Counts the warp's operations in `*to`. Warps on several threads need separate counters.
struct counted {
    static constexpr bool counts = true;  ///< whether operations are counted
    counters* to;                         ///< the counters to increment
};

/// The fast emulator: one thread runs a warp of 8, 16, 32 or 64 lanes in SIMD registers. The value type
/// is `warpagg::simd_value<T, Size>`, so kernels are masked code: they use `select` and uniform
/// branches. Lanes commit in the order of their numbers. A 32-bit value takes one register of 256
/// bits with 8 lanes, and four with 32 lanes. A kernel with 32 lanes and many values therefore keeps
/// most of them in memory.
template <class Counting, unsigned Size = 32>
struct basic_lanes : Counting {
    /// The member of this name of the concept `warp`.
    /// @{
    static constexpr unsigned size = Size;
    template <class T>
    using value = warpagg::simd_value<T, static_cast<int>(Size)>;
    using mask = value<bool>;
    using lane_bits = lane_bits_t<basic_lanes>;

    WARPAGG_HD value<unsigned> lane() const {
        value<unsigned> r;
        WARPAGG_UNROLL
        for (int i = 0; i < static_cast<int>(size); ++i) r.set(i, static_cast<unsigned>(i));
        return r;
    }

    WARPAGG_HD lane_bits ballot(const mask& p) const {
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
        for (int i = 0; i < static_cast<int>(size); ++i) r.set(i, v[static_cast<int>(from[i] % size)]);
        return r;
    }
    template <class Key>
    WARPAGG_HD value<lane_bits> match(const value<Key>& key) const {
        count([](counters& c) { ++c.votes; });
        value<lane_bits> r;
        WARPAGG_UNROLL
        for (int i = 0; i < static_cast<int>(size); ++i) r.set(i, bits(key == value<Key>(key[i])));
        return r;
    }
    template <class T>
    WARPAGG_HD value<T> shfl_down(const value<T>& v, unsigned distance) const {
        count_shuffle<T>();
        switch (distance) {
            case 32:
                return down<32>(v);
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
            case 32:
                return across<32>(v);
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
        static_assert(N % 4 == 0);
        if constexpr (value<T>::width == 8) {
            static constexpr T nothing[N]{};
            for_each_chunk(from, nothing, index, active, [&](int i, const T* const(&record)[8]) {
                WARPAGG_UNROLL
                for (int k = 0; k < N; k += 4) {
                    typename value<T>::chunk four[4];
                    WARPAGG_UNROLL
                    for (int j = 0; j < 4; ++j) join(record[j] + k, record[j + 4] + k, four[j]);
                    transpose(four);
                    WARPAGG_UNROLL
                    for (int j = 0; j < 4; ++j) v[k + j].part[i] = four[j];
                }
            });
        } else {
            for (unsigned k = 0; k < N; ++k) v[k] = load(from + k, index, active);
        }
    }
    template <class T>
    WARPAGG_HD void store(T* to, const value<unsigned>& index, const value<T>& v, const mask& active) const {
        for_each_lane(bits(active), [&](int lane) { to[index[lane]] = v[lane]; });
    }
    template <class T, int N>
    WARPAGG_HD void store_packed(T* to, const value<unsigned>& index, const value<T> (&v)[N],
                                 const mask& active) const {
        static_assert(N % 4 == 0);
        if constexpr (value<T>::width == 8) {
            T nowhere[N];
            for_each_chunk(to, nowhere, index, active, [&](int i, T* const(&record)[8]) {
                WARPAGG_UNROLL
                for (int k = 0; k < N; k += 4) {
                    typename value<T>::chunk four[4];
                    WARPAGG_UNROLL
                    for (int j = 0; j < 4; ++j) four[j] = v[k + j].part[i];
                    transpose(four);
                    WARPAGG_UNROLL
                    for (int j = 0; j < 4; ++j) part(four[j], record[j] + k, record[j + 4] + k);
                }
            });
        } else {
            for (unsigned k = 0; k < N; ++k) store(to + k, index, v[k], active);
        }
    }
    WARPAGG_HD void sync() const {}
    template <class T>
    WARPAGG_HD value<T> load_row(const T* from, std::ptrdiff_t first, const mask& active) const {
        value<T> r;
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i) {
            const T* p = from + first + i * r.width;  // mutate: row_loaded_from_its_start
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
    WARPAGG_HD value<T> load_row(const T* from, std::ptrdiff_t first) const {
        value<T> r;
        WARPAGG_UNROLL
        for (int i = 0; i < r.chunks; ++i)
            std::memcpy(&r.part[i], from + first + i * r.width, sizeof r.part[i]);
        return r;
    }
    template <class T>
    WARPAGG_HD void store_row(T* to, std::ptrdiff_t first, const value<T>& v, const mask& active) const {
        WARPAGG_UNROLL
        for (int i = 0; i < v.chunks; ++i) {
            T* p = to + first + i * v.width;
#if defined(__AVX2__)
            if constexpr (sizeof(T) == 4) {
                if (_mm256_movemask_ps(reinterpret_cast<__m256>(active.part[i])) == 0xff) {
                    std::memcpy(p, &v.part[i], sizeof v.part[i]);  // faster than a masked store on some CPUs
                } else {
                    _mm256_maskstore_epi32(reinterpret_cast<int*>(p),
                                           reinterpret_cast<__m256i>(active.part[i]),
                                           reinterpret_cast<__m256i>(v.part[i]));
                }
                continue;
            }
#endif
            WARPAGG_UNROLL
            for (int k = 0; k < v.width; ++k)
                // mutate: row_stored_by_inactive_lanes
                if (active[i * v.width + k]) p[k] = v[i * v.width + k];
        }
    }
    template <class Op, class Dst, class T>
    WARPAGG_HD void atomic(Op op, Dst dst, const value<unsigned>& index, const value<T>& v,
                           const mask& active) const {
        commit(op, dst, index, v, active);
    }
    template <class Op, class Dst, std::same_as<std::uint64_t> Index, class T>
    WARPAGG_HD void atomic(Op op, Dst dst, const value<Index>& index, const value<T>& v,
                           const mask& active) const {
        commit(op, dst, index, v, active);
    }

    /// @}

    /// Counts a library call by its number of active lanes. The library calls this, not kernels.
    WARPAGG_HD void observe(const mask& active) const requires(Counting::counts) {
        ++this->to->active[static_cast<std::size_t>(std::popcount(bits(active)))];
    }

  private:
    template <class Op, class Dst, class Index, class T>
    WARPAGG_HD void commit(Op op, Dst dst, const value<Index>& index, const value<T>& v,
                           const mask& active) const {
        const lane_bits who = bits(active);
        count([&](counters& c) { count_commit(c, dst, index, who); });
        for_each_lane(who, [&](int lane) { detail::atomic(op, dst(index[lane]), v[lane]); });
    }
    template <class F>
    WARPAGG_HD void count(F f) const {
        if constexpr (Counting::counts) f(*this->to);
    }
    template <class T>
    WARPAGG_HD void count_shuffle() const {
        count([](counters& c) { c.shuffles += (sizeof(T) + 3) / 4; });  // mutate: shuffles_counted_by_value
    }
    template <class Dst, class Index>
    static void count_commit(counters& c, Dst dst, const value<Index>& index, lane_bits who) {
        if (who == 0) return;
        ++c.commits;
        std::uintptr_t sectors[size];
        unsigned known = 0;
        for_each_lane(who, [&](int lane) {
            ++c.atomics;
            // mutate: sectors_of_64_bytes
            const auto sector = reinterpret_cast<std::uintptr_t>(dst(index[lane])) / 32;
            unsigned i = 0;
            while (i < known && sectors[i] != sector) ++i;
            if (i == known) sectors[known++] = sector;
        });
        c.sectors += known;
    }

    static WARPAGG_HD lane_bits bits(const mask& p) {
        lane_bits r = 0;
#if defined(__AVX__)
        WARPAGG_UNROLL
        for (int i = 0; i < p.chunks; ++i)
            r |= lane_bits{static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(p.part[i])))}
                 << (i * p.width);
#else
        typename mask::element flags[size];  // subscripts of vectors fail in GCC 12 with sanitizers
        static_assert(sizeof flags == sizeof p.part);
        std::memcpy(flags, p.part, sizeof flags);
        WARPAGG_UNROLL
        for (unsigned i = 0; i < size; ++i) r |= lane_bits{flags[i] != 0 ? 1u : 0u} << i;
#endif
        return r;
    }
    template <class F>
    static WARPAGG_HD void for_each_lane(lane_bits who, F f) {
        for (; who != 0; who &= who - 1) f(std::countr_zero(who));
    }

    /// Calls f(i, records) for each chunk i of 8 lanes. `records` has the address of each active lane's
    /// record, and `of_inactive` for each inactive lane.
    template <class T, class U, class F>
    static WARPAGG_HD void for_each_chunk(T* first, U* of_inactive, const value<unsigned>& index,
                                          const mask& active, const F& f) {
        const lane_bits who = bits(active);
        WARPAGG_UNROLL
        for (int i = 0; i < index.chunks; ++i) {
            T* record[8];
            WARPAGG_UNROLL
            for (int j = 0; j < 8; ++j)
                record[j] = ((who >> (8 * i + j)) & 1u) != 0 ? first + index[8 * i + j] : of_inactive;
            f(i, record);
        }
    }
    /// Joins two groups of four 32-bit values into one chunk, or parts a chunk into two groups.
    /// @{
    template <class T, class Chunk>
    static WARPAGG_HD void join(const T* low, const T* high, Chunk& both) {
        typedef T half __attribute__((vector_size(16)));
        half l, h;
        std::memcpy(&l, low, sizeof l);
        std::memcpy(&h, high, sizeof h);
        both = __builtin_shufflevector(l, h, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    template <class T, class Chunk>
    static WARPAGG_HD void part(const Chunk& both, T* low, T* high) {
        const auto l = __builtin_shufflevector(both, both, 0, 1, 2, 3);
        const auto h = __builtin_shufflevector(both, both, 4, 5, 6, 7);
        std::memcpy(low, &l, sizeof l);
        std::memcpy(high, &h, sizeof h);
    }
    /// @}
    /// Transposes two 4×4 matrices: one in the lower halves of the four chunks, one in the upper halves.
    template <class Chunk>
    static WARPAGG_HD void transpose(Chunk (&c)[4]) {
        const Chunk a = __builtin_shufflevector(c[0], c[1], 0, 8, 1, 9, 4, 12, 5, 13);
        const Chunk b = __builtin_shufflevector(c[2], c[3], 0, 8, 1, 9, 4, 12, 5, 13);
        const Chunk d = __builtin_shufflevector(c[0], c[1], 2, 10, 3, 11, 6, 14, 7, 15);
        const Chunk e = __builtin_shufflevector(c[2], c[3], 2, 10, 3, 11, 6, 14, 7, 15);
        c[0] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
        c[1] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
        c[2] = __builtin_shufflevector(d, e, 0, 1, 8, 9, 4, 5, 12, 13);
        c[3] = __builtin_shufflevector(d, e, 2, 3, 10, 11, 6, 7, 14, 15);
    }

    template <unsigned D, class T>
    static WARPAGG_HD value<T> down(const value<T>& v) {
        constexpr int width = value<T>::width, chunks = value<T>::chunks, d = static_cast<int>(D);
        constexpr int last = chunks - 1;
        value<T> r;
        if constexpr (d >= width) {
            constexpr int step = d / width;
            WARPAGG_UNROLL
            // mutate: shuffle_down_past_the_end
            for (int i = 0; i < chunks; ++i) r.part[i] = v.part[i + step < chunks ? i + step : i];
        } else {
            [&]<std::size_t... I>(std::index_sequence<I...>) {
                WARPAGG_UNROLL
                for (int i = 0; i < last; ++i)
                    r.part[i] =
                        __builtin_shufflevector(v.part[i], v.part[i + 1], (static_cast<int>(I) + d)...);
                r.part[last] = __builtin_shufflevector(
                    v.part[last], v.part[last],
                    (static_cast<int>(I) + d < width ? static_cast<int>(I) + d : static_cast<int>(I))...);
            }
            (std::make_index_sequence<static_cast<std::size_t>(width)>{});
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
                r.part[i] = v.part[(i ^ (d / width)) % r.chunks];
            } else {
                [&]<std::size_t... I>(std::index_sequence<I...>) {
                    // mutate: shuffle_xor_one_lane_off
                    r.part[i] = __builtin_shufflevector(v.part[i], v.part[i], (static_cast<int>(I) ^ d)...);
                }
                (std::make_index_sequence<static_cast<std::size_t>(width)>{});
            }
        }
        return r;
    }
};

/// The fast emulator with 32 lanes and no counters.
using lanes = basic_lanes<uncounted>;
/// The fast emulator with 32 lanes and counters, as in `counted_lanes{{&counters}}`.
using counted_lanes = basic_lanes<counted>;
/// The fast emulator with 8 or 16 lanes and no counters.
template <unsigned Size>
using narrow_lanes = basic_lanes<uncounted, Size>;
/// The fast emulator with 64 lanes and no counters. AMD's GPUs for data centers have warps of 64 lanes.
using wide_lanes = basic_lanes<uncounted, 64>;

static_assert(warpagg::warp<lanes> && warpagg::warp<counted_lanes>);
static_assert(warpagg::warp<narrow_lanes<8>> && warpagg::warp<narrow_lanes<16>>);
static_assert(warpagg::warp<wide_lanes>);

}  // namespace warpagg::emulator
