// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Pairs of halves as values of the tests: small whole numbers, whose sums are exact in any order.

#include <cuda_bf16.h>
#include <cuda_fp16.h>

#include "cases.hpp"

namespace {

template <class Pair, class Half>
struct values_of_pairs {
    static Pair draw(kind k, std::mt19937_64& random) {
        const auto whole = [&] {  // 33 of them: below 256, bfloat16's limit
            return Half(k == kind::zeros ? 0.0f : static_cast<float>(random() % 9) - 4.0f);
        };
        const Half x = whole();
        return Pair(x, whole());
    }
    static Pair poison(unsigned number) {
        const float all[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                             1.0f};
        return Pair(Half(all[number % 3]), Half(all[(number + 1) % 3]));
    }
};
template <>
struct values_of<__half2> : values_of_pairs<__half2, __half> {};
template <>
struct values_of<__nv_bfloat162> : values_of_pairs<__nv_bfloat162, __nv_bfloat16> {};

}  // namespace
