// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

/// As it was at first.
template <class W>
WARPAGG_HD void add_moments(const W& w, unsigned i, const float* samples, unsigned n, float* moments) {
    if (i >= n) return;
    const float x = samples[i];
    warpagg::warp_reduce_atomic(w, moments, {1.0f, x, x * x}, true);
}
