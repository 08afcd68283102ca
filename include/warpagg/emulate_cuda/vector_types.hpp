// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// CUDA's vector types: `float4`, `make_float4`, `dim3`.

// Defines the types of 1 to 4 values of type T and their functions, as make_float4. `pair` and `quad` are
// the alignments of 2 and of 4 values.
#define WARPAGG_VECTOR_TYPES(T, NAME, pair, quad)                                                        \
    struct NAME##1 {                                                                                     \
        T x;                                                                                             \
    };                                                                                                   \
    struct alignas(pair) NAME##2 {                                                                       \
        T x, y;                                                                                          \
    };                                                                                                   \
    struct NAME##3 {                                                                                     \
        T x, y, z;                                                                                       \
    };                                                                                                   \
    struct alignas(quad) NAME##4 {                                                                       \
        T x, y, z, w;                                                                                    \
    };                                                                                                   \
    __attribute__((always_inline)) constexpr NAME##1 make_##NAME##1(T x) { return {x}; }                 \
    __attribute__((always_inline)) constexpr NAME##2 make_##NAME##2(T x, T y) { return {x, y}; }         \
    __attribute__((always_inline)) constexpr NAME##3 make_##NAME##3(T x, T y, T z) { return {x, y, z}; } \
    __attribute__((always_inline)) constexpr NAME##4 make_##NAME##4(T x, T y, T z, T w) {                \
        return {x, y, z, w};                                                                             \
    }

WARPAGG_VECTOR_TYPES(signed char, char, 2, 4)
WARPAGG_VECTOR_TYPES(unsigned char, uchar, 2, 4)
WARPAGG_VECTOR_TYPES(short, short, 4, 8)
WARPAGG_VECTOR_TYPES(unsigned short, ushort, 4, 8)
WARPAGG_VECTOR_TYPES(int, int, 8, 16)
WARPAGG_VECTOR_TYPES(unsigned, uint, 8, 16)
WARPAGG_VECTOR_TYPES(float, float, 8, 16)
WARPAGG_VECTOR_TYPES(double, double, 16, 16)
#undef WARPAGG_VECTOR_TYPES

/// The extents of a grid or of a block; those that are not given are 1.
struct dim3 {
    unsigned x, y, z;  ///< the extents
    /// @{
    /// Works as CUDA's.
    constexpr dim3(unsigned x_ = 1, unsigned y_ = 1, unsigned z_ = 1) : x(x_), y(y_), z(z_) {}
    constexpr dim3(const uint3& v) : x(v.x), y(v.y), z(v.z) {}
    constexpr operator uint3() const { return {x, y, z}; }
    /// @}
};
