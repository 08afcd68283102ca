// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "../raster/gaussian_row.hpp"
#include "../raster/list_room.hpp"
#include "watch.hpp"

namespace gs::train {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::select;

/// One step of Adam (Kingma and Ba 2015, algorithm 1, with the corrections of bias folded into the rate) for
/// what `project_backward` gives it; their t counts all steps, those that a Gaussian took no part in, too. A
/// gradient that is not finite, or whose square would not be, is left out, and so is a step that would not
/// end in a finite value: value and moments stay as they were. Squared, such a gradient would hold its value
/// still for ever.
template <class Real>
struct adam {
    parameter_arrays<Real> values, first, second;  ///< and the moments
    Real rates[parameter_count];                   ///< of this step: alpha / (1 - beta1^t)
    Real correction;                               ///< 1 / sqrt(1 - beta2^t)
    raster::list_room room;                        ///< of the view: see there
    train::watch watch;

    static constexpr double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-15;
    static constexpr double most_gradient = 1e18;

    static constexpr bool takes_zeros = false;
    WARPAGG_HD bool idle() const { return room.exceeded(); }

    template <class W, int N, class V>
    WARPAGG_HD void operator()(const W& w, const raster::gaussian_row<W>& row, parameter p, std::size_t k,
                               std::size_t width, const glm::vec<N, V>& value,
                               const glm::vec<N, V>& gradient) const {
        const glm::vec<N, V> m = row.template load<N>(w, first[p], k, width);
        const glm::vec<N, V> v = row.template load<N>(w, second[p], k, width);
        const V rate(rates[static_cast<int>(p)]), most = constant<V>(most_gradient);
        mask_t<W> bounded[N], sound[N], all_sound = true;
        WARPAGG_UNROLL
        for (int n = 0; n < N; ++n) {
            const V g = gradient[n];
            const V next_m = constant<V>(beta1) * m[n] + constant<V>(1 - beta1) * g;
            const V next_v = constant<V>(beta2) * v[n] + constant<V>(1 - beta2) * g * g;
            const V spread = warpagg::math::approximate_sqrt(next_v) * V(correction) + constant<V>(epsilon);
            const V next = value[n] - warpagg::math::divide(rate * next_m, spread);
            bounded[n] = g < most && -g < most;
            sound[n] = bounded[n] && raster::is_finite(next);
            all_sound = all_sound && sound[n];
            row.store(w, first[p], k, n, width, next_m, m[n], sound[n]);
            row.store(w, second[p], k, n, width, next_v, v[n], sound[n]);
            row.store(w, values[p], k, n, width, next, value[n], sound[n]);
        }
        if (!w.any(row.active && !all_sound)) return;
        using number = value_t<W, unsigned>;
        number gradients(0), parameters(0);
        WARPAGG_UNROLL
        for (int n = 0; n < N; ++n) {
            gradients += select(row.active && !bounded[n], number(1), number(0));
            parameters += select(row.active && bounded[n] && !sound[n], number(1), number(0));
        }
        watch.note(w, fault::gradient, p, row.first, gradients);
        watch.note(w, fault::parameter, p, row.first, parameters);
    }
};

}  // namespace gs::train
