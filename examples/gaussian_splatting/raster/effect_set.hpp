// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs {

/// What the projection of Gaussians simulates on demand. Kernels have it as a template parameter: what is off
/// is not compiled in. See docs/effects.md.
struct effect_set {
    bool antialiasing = false;  ///< a Gaussian that a pixel's filter widens becomes fainter by as much
};

namespace raster {

/// Calls `f.template operator()<set>()`.
template <class F>
decltype(auto) with_effects(const effect_set& set, const F& f) {
    if (set.antialiasing) return f.template operator()<effect_set{.antialiasing = true}>();
    return f.template operator()<effect_set{}>();
}

}  // namespace raster
}  // namespace gs
