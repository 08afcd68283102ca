// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/core/compiler.hpp>

namespace gs {

/// Returns 32 random bits for each `i`, which `key` selects. `Number` is the type of 32-bit unsigned
/// integers of a warp. Source: the finalizer of MurmurHash3 (Appleby 2011).
template <class Number>
WARPAGG_HD Number counter_hash(const Number& i, std::uint32_t key) {
    Number h = (i ^ Number(key)) * Number(0x9e3779b1u);
    h = (h ^ (h >> Number(16u))) * Number(0x85ebca6bu);
    h = (h ^ (h >> Number(13u))) * Number(0xc2b2ae35u);
    return h ^ (h >> Number(16u));
}

}  // namespace gs
