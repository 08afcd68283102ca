// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <warpagg/warp/concept.hpp>

#include "../geometry/vectors.hpp"

namespace gs::raster {

/// The background behind all splats: a constant color, or an image. `at` returns one channel at the
/// pixels of a warp. `pixel` is the index in a plane, which has `plane` pixels.
/// @{
template <class Real>
struct constant_background {
    vec3<Real> color;

    template <class W>
    WARPAGG_HD warpagg::value_t<W, Real> at(const W&, const warpagg::value_t<W, unsigned>&, unsigned channel,
                                            unsigned, const warpagg::mask_t<W>&) const {
        return warpagg::value_t<W, Real>(color[static_cast<int>(channel)]);
    }
};
template <class Real>
struct image_background {
    const Real* planes;  ///< three planes of the size of the render

    template <class W>
    WARPAGG_HD warpagg::value_t<W, Real> at(const W& w, const warpagg::value_t<W, unsigned>& pixel,
                                            unsigned channel, unsigned plane,
                                            const warpagg::mask_t<W>& inside) const {
        return w.load(planes, pixel + channel * plane, inside);
    }
};
/// @}

}  // namespace gs::raster
