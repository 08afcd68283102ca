// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../scene/camera.hpp"

namespace gs {

/// Optional effects of the projection of Gaussians and of its gradient. Kernels take the set as a
/// template parameter, so that effects that are off cost nothing. See
/// docs/explanation/how_effects_are_chosen.md.
struct effect_set {
    bool antialiasing = false;              ///< 2D Mip filter: see `opacity_left`
    lens_model lens = lens_model::pinhole;  ///< the lens of the camera
    bool depth = false;                     ///< the gradient includes inverse depths
    bool motion = false;                    ///< blur and rolling shutter: see `splat_motion`
};

namespace raster {

/// Calls `f.template operator()<flag>()`: turns a run-time flag into a template argument.
template <class F>
decltype(auto) with_flag(bool flag, const F& f) {
    if (flag) return f.template operator()<true>();
    return f.template operator()<false>();
}
/// Calls `f.template operator()<lens>()`: turns a run-time lens into a template argument.
template <class F>
decltype(auto) with_lens(lens_model lens, const F& f) {
    switch (lens) {
        case lens_model::fisheye:
            return f.template operator()<lens_model::fisheye>();
        case lens_model::panorama:
            return f.template operator()<lens_model::panorama>();
        default:
            return f.template operator()<lens_model::pinhole>();
    }
}
/// Calls `f.template operator()<motion>()`. Panoramas have no motion.
template <lens_model Lens, class F>
decltype(auto) with_motion(bool motion, const F& f) {
    if constexpr (Lens == lens_model::panorama)
        return f.template operator()<false>();
    else
        return with_flag(motion, f);
}
/// Calls `f.template operator()<set>()`: turns a run-time set into a template argument.
template <class F>
decltype(auto) with_effects(const effect_set& set, const F& f) {
    return with_flag(set.antialiasing, [&]<bool Antialiasing>() -> decltype(auto) {
        return with_lens(set.lens, [&]<lens_model Lens>() -> decltype(auto) {
            return with_flag(set.depth, [&]<bool Depth>() -> decltype(auto) {
                return with_motion<Lens>(set.motion, [&]<bool Motion>() -> decltype(auto) {
                    return f.template operator()<effect_set{Antialiasing, Lens, Depth, Motion}>();
                });
            });
        });
    });
}

}  // namespace raster
}  // namespace gs
