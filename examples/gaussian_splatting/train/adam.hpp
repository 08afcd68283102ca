// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <warpagg/simt/warp.hpp>

#include "../raster/list_room.hpp"
#include "watch.hpp"

namespace gs::train {

/// One step of Adam (Kingma and Ba 2015, algorithm 1, with the corrections of bias folded into the rate): one
/// index a value. A gradient that is not finite, or whose square would not be, is left out, and so is a step
/// that would not end in a finite value: value and moments stay as they were. Squared, such a gradient would
/// hold its value still for ever.
template <class Real>
struct adam {
    Real* values;
    Real* first;  ///< moments
    Real* second;
    const Real* gradients;
    Real rate;               ///< of this step: alpha / (1 - beta1^t)
    Real correction;         ///< 1 / sqrt(1 - beta2^t)
    raster::list_room room;  ///< of the view: see there
    train::watch watch;
    std::uint32_t parameter, width;  ///< which one this is, for the watch, and its values a Gaussian

    static constexpr double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-15;
    static constexpr double most_gradient = 1e18;

    WARPAGG_HD bool skip() const { return room.exceeded(); }

    /// Whether the step was taken.
    WARPAGG_HD bool operator()(std::size_t i) const {
        const Real g = gradients[i];
        const Real m = Real(beta1) * first[i] + Real(1 - beta1) * g;
        const Real v = Real(beta2) * second[i] + Real(1 - beta2) * g * g;
        const Real next = values[i] - rate * m / (warpagg::math::sqrt(v) * correction + Real(epsilon));
        const bool sound = is_sound(g) && next - next == 0;
        first[i] = sound ? m : first[i];
        second[i] = sound ? v : second[i];
        values[i] = sound ? next : values[i];
        return sound;
    }

    /// Says what was wrong where no step was taken.
    WARPAGG_HD void report(std::size_t i) const {
        const auto kind = is_sound(gradients[i]) ? fault::parameter : fault::gradient;
        watch.note(kind, parameter, static_cast<std::uint32_t>(i / width));
    }

  private:
    static WARPAGG_HD bool is_sound(Real g) { return g < Real(most_gradient) && -g < Real(most_gradient); }
};

}  // namespace gs::train
