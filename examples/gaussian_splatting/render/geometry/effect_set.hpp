// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs {

/// What the projection of Gaussians, or its gradient, simulates on demand. Kernels have it as a template
/// parameter: what is off is not compiled in. See docs/explanation/how_effects_are_chosen.md.
struct effect_set {
    bool antialiasing = false;  ///< a Gaussian that a pixel's filter widens becomes fainter by as much
    bool fisheye = false;       ///< the camera has such a lens
    bool depth = false;         ///< inverse depths have gradients, too
};

namespace raster {

/// Calls `f.template operator()<flag>()`.
template <class F>
decltype(auto) with_flag(bool flag, const F& f) {
    if (flag) return f.template operator()<true>();
    return f.template operator()<false>();
}
/// Calls `f.template operator()<set>()`.
template <class F>
decltype(auto) with_effects(const effect_set& set, const F& f) {
    return with_flag(set.antialiasing, [&]<bool Antialiasing>() -> decltype(auto) {
        return with_flag(set.fisheye, [&]<bool Fisheye>() -> decltype(auto) {
            return with_flag(set.depth, [&]<bool Depth>() -> decltype(auto) {
                return f.template operator()<effect_set{Antialiasing, Fisheye, Depth}>();
            });
        });
    });
}

}  // namespace raster
}  // namespace gs
