// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/atomic.hpp>

/// Adds the number of samples, their sum and the sum of their squares to moments[0..3). One thread per
/// sample.
template <class W>
WARPAGG_HD void add_moments(const W& w, unsigned i, const float* samples, unsigned n, float* moments) {
    const bool active = i < n;
    const float x = active ? samples[i] : 0.0f;
    warpagg::warp_reduce_atomic(w, moments, {1.0f, x, x * x}, active);
}
