// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/warp/concept.hpp>

#include "../image/masked_pixel.hpp"

namespace gs::train {

/// Returns the values, in [0, 1], that a render should have at target pixels (premultiplied RGBA).
/// `channel` is 0 for red, 1 for green and 2 for blue; `background` is the value of this channel
/// behind the target.
template <class W, class Real>
WARPAGG_HD warpagg::value_t<W, Real> target_value(const warpagg::value_t<W, unsigned>& rgba, int channel,
                                                  const Real& background) {
    using number = warpagg::value_t<W, unsigned>;
    using real = warpagg::value_t<W, Real>;
    using warpagg::math::convert;
    using warpagg::math::fma;
    const auto fraction = [](const number& byte) {  // byte / 255, rounded once
        constexpr Real unit = Real(1) / 255;
        const real n = convert<Real>(convert<int>(byte)), q = n * unit;
        return fma(fma(q, real(-255), n), real(unit), q);
    };
    const real transparency = fraction(255u - (rgba >> number(24u)));
    const number shift(8 * static_cast<unsigned>(channel));
    return fraction((rgba >> shift) & 255u) + transparency * background;
}

/// Returns whether each target pixel is masked. The pixels start at `pixel`, one per lane.
template <class W>
WARPAGG_HD warpagg::mask_t<W> is_masked(const W& w, const std::uint32_t* target, std::ptrdiff_t pixel,
                                        const warpagg::mask_t<W>& inside) {
    return w.load_row(target, pixel, inside) == warpagg::value_t<W, unsigned>(masked_pixel);
}

}  // namespace gs::train
