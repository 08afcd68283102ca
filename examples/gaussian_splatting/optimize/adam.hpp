// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../render/geometry/list_capacity.hpp"
#include "../render/project/gaussian_row.hpp"
#include "finite_check.hpp"

namespace gs::train {

using warpagg::mask_t;
using warpagg::value_t;
using warpagg::math::select;

/// One step of Adam (Kingma and Ba 2015, algorithm 1) for the gradients from `project_backward`.
/// The bias corrections are folded into the learning rate.
///
/// Updates only the Gaussians that the view shows. A Gaussian that missed k steps had zero
/// gradients in them: its moments decayed by beta1^k and beta2^k, and its value moved by the sum of
/// a geometric series. The step first catches up on these k steps, with the current learning rate
/// and bias corrections. This is an approximation if k is large.
///
/// A value and its moments stay as they are if the gradient is not finite or too large to square,
/// or if the new value would not be finite. The missed steps are then forgotten. (The square of
/// such a gradient would prevent all later updates of the value.) Missed steps are also forgotten
/// for SH coefficients that this step does not update.
template <class Real>
struct adam {
    parameter_arrays<Real> values, first, second;  ///< parameters, first and second moments
    std::uint32_t* last_step;                      ///< last step that updated each Gaussian
    std::uint32_t step;                            ///< number t of this step, counted from 1
    Real rates[parameter_count];                   ///< alpha / (1 - beta1^t)
    Real correction;                               ///< 1 / sqrt(1 - beta2^t)
    raster::list_capacity capacity;                ///< capacity of the view's tile lists
    finite_check check;

    static constexpr double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-15;
    static constexpr double most_gradient = 1e18;

    static constexpr bool takes_zeros = false;
    WARPAGG_HD bool idle() const { return capacity.exceeded(); }

    template <class W>
    struct row_sink {
        using real = value_t<W, Real>;

        const adam& of;
        const W& w;
        const raster::gaussian_row<W>& row;
        real first_left, second_left;  ///< decay during the missed steps: beta1^k, beta2^k
        real drift;                    ///< movement in these steps, in units of rate m / sqrt(v)

        template <int N>
        WARPAGG_HD void operator()(parameter p, std::size_t k, std::size_t width,
                                   const glm::vec<N, real>& value, const glm::vec<N, real>& gradient) const {
            const glm::vec<N, real> m = row.template load<N>(w, of.first[p], k, width);
            const glm::vec<N, real> v = row.template load<N>(w, of.second[p], k, width);
            const real rate(of.rates[static_cast<int>(p)]), most = constant<real>(most_gradient);
            mask_t<W> bounded[N], valid[N], all_valid = true;
            WARPAGG_UNROLL
            for (int n = 0; n < N; ++n) {
                const real g = gradient[n];
                const real next_m = constant<real>(beta1) * first_left * m[n] + constant<real>(1 - beta1) * g;
                const real next_v =
                    constant<real>(beta2) * second_left * v[n] + constant<real>(1 - beta2) * g * g;
                const real next =
                    value[n] - rate * (of.relative(drift * m[n], v[n]) + of.relative(next_m, next_v));
                bounded[n] = g < most && -g < most;  // mutate: squared_without_bound
                valid[n] = bounded[n] && raster::is_finite(next);
                all_valid = all_valid && valid[n];
                row.store(w, of.first[p], k, n, width, next_m, m[n], valid[n]);
                row.store(w, of.second[p], k, n, width, next_v, v[n], valid[n]);
                row.store(w, of.values[p], k, n, width, next, value[n], valid[n]);
            }
            if (!w.any(row.active && !all_valid)) return;
            using number = value_t<W, unsigned>;
            number gradients(0), parameters(0);
            WARPAGG_UNROLL
            for (int n = 0; n < N; ++n) {
                gradients += select(row.active && !bounded[n], number(1), number(0));
                parameters += select(row.active && bounded[n] && !valid[n], number(1), number(0));
            }
            of.check.note(w, fault_kind::gradient, p, row.first, gradients);
            of.check.note(w, fault_kind::parameter, p, row.first, parameters);
        }
    };

    /// Prepares the step of the row's active Gaussians.
    template <class W>
    WARPAGG_HD row_sink<W> for_row(const W& w, const raster::gaussian_row<W>& row) const {
        using real = value_t<W, Real>;
        using number = value_t<W, std::uint32_t>;
        const auto at = static_cast<std::ptrdiff_t>(row.first);
        const number last = w.load_row(last_step, at, row.active);
        w.store_row(last_step, at, number(step), row.active);
        const real missed = warpagg::math::convert<Real>(number(step - 1) - last);
        // The drift is r + r^2 + ... + r^k = r / (1 - r) (1 - r^k) with r = beta1 / sqrt(beta2).
        // The factors of `missed` are log2 of beta1, beta2 and r.
        const real first_left = warpagg::math::exp2(constant<real>(-0.15200309344504995) * missed);
        const real second_left = warpagg::math::exp2(constant<real>(-0.0014434168696687186) * missed);
        const real r_left = warpagg::math::exp2(constant<real>(-0.15128138501021560) * missed);
        return {*this, w, row, first_left, second_left, constant<real>(9.0452374997021932) * (1 - r_left)};
    }

  private:
    /// Returns m / sqrt(v + epsilon^2), with v corrected for bias. Its magnitude is between 1 and
    /// sqrt(2) times that of the paper's m / (sqrt(v) + epsilon).
    template <class V>
    WARPAGG_HD V relative(const V& m, const V& v) const {
        const V variance = warpagg::math::fma(v, V(correction * correction), constant<V>(epsilon * epsilon));
        return m * warpagg::math::inverse_sqrt(variance);
    }
};

}  // namespace gs::train
