// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs {

/// What the projection of Gaussians simulates on demand. Kernels have it as a template parameter: what is off
/// is not compiled in. See docs/effects.md.
struct effect_set {
    bool antialiasing = false;  ///< a Gaussian that a pixel's filter widens becomes fainter by as much
    bool fisheye = false;       ///< the camera has such a lens
};

namespace raster {

/// Calls `f.template operator()<set>()`.
template <class F>
decltype(auto) with_effects(const effect_set& set, const F& f) {
    const auto with_lens = [&]<bool Antialiasing>() -> decltype(auto) {
        if (set.fisheye)
            return f.template operator()<effect_set{.antialiasing = Antialiasing, .fisheye = true}>();
        return f.template operator()<effect_set{.antialiasing = Antialiasing}>();
    };
    if (set.antialiasing) return with_lens.template operator()<true>();
    return with_lens.template operator()<false>();
}

}  // namespace raster
}  // namespace gs
