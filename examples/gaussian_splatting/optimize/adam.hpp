// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../render/geometry/list_capacity.hpp"
#include "../render/project/gaussian_row.hpp"
#include "finite_check.hpp"
#include "moment_arrays.hpp"

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
/// or if the new value would not be finite. The missed steps are then forgotten. (The square of such a
/// gradient would prevent all later updates of the value.) Missed steps are also forgotten for SH
/// coefficients that this step does not update. With compact moments, one such channel of an SH
/// coefficient keeps all three channels as they are.
template <class Real, moment_precision Precision = moment_precision::full>
struct adam {
    parameter_arrays<Real> values;
    moment_arrays moments;           ///< with this precision
    std::uint32_t* last_step;        ///< last step that updated each Gaussian
    std::uint32_t step;              ///< number t of this step, counted from 1
    Real rates[parameter_count];     ///< alpha / (1 - beta1^t)
    Real correction;                 ///< 1 / sqrt(1 - beta2^t)
    raster::list_capacity capacity;  ///< capacity of the view's tile lists
    finite_check check;

    static constexpr double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-15;
    static constexpr double most_gradient = 1e18;

    static constexpr bool takes_zeros = false;
    WARPAGG_HD bool idle() const { return capacity.exceeded(); }

    template <class W>
    struct row_sink {
        using real = value_t<W, Real>;
        using word = value_t<W, std::uint32_t>;

        const adam& of;
        const W& w;
        const raster::gaussian_row<W>& row;
        real first_left, second_left;  ///< decay during the missed steps: beta1^k, beta2^k
        real drift;                    ///< movement in these steps, in units of rate m / sqrt(v)
        std::uint32_t cache_slot;      ///< see `parameter_arrays::cache_slot`
        /// The compact second moment of all SH coefficients, before and after SH degree 0 is updated.
        mutable real color_before, color_after;

        template <int N>
        WARPAGG_HD_CALLED void operator()(parameter p, std::size_t k, std::size_t width,
                                          const glm::vec<N, real>& value,
                                          const glm::vec<N, real>& gradient) const {
            change<N> by(*this, p, value, gradient);
            if constexpr (Precision == moment_precision::full)
                step_with_floats(by, p, k, width);
            else if (p < parameter::sh0)
                step_with_pairs(by, p, k, width);
            else if constexpr (N == 3)
                step_with_colors(by, p, k, width);
            if (!w.any(row.active && !by.all_valid)) return;
            note(by, p);
        }

      private:
        /// The change of N components.
        template <int N>
        struct change {
            const row_sink& sink;
            real rate;
            const glm::vec<N, real>&value, &gradient;
            real next_first[N], next[N];
            mask_t<W> bounded[N], valid[N], all_valid = true;

            WARPAGG_HD change(const row_sink& of, parameter p, const glm::vec<N, real>& before,
                              const glm::vec<N, real>& by)
                : sink(of), rate(of.of.rates[static_cast<int>(p)]), value(before), gradient(by) {}

            /// Computes component n from its moments m and v, and from the next v.
            WARPAGG_HD void compute(int n, const real& m, const real& v, const real& next_v) {
                const real g = gradient[n];
                next_first[n] = constant<real>(beta1) * sink.first_left * m + constant<real>(1 - beta1) * g;
                next[n] = value[n] - rate * (sink.of.relative(sink.drift * m, v) +
                                             sink.of.relative(next_first[n], next_v));
                const real most = constant<real>(most_gradient);
                bounded[n] = g < most && -g < most;  // mutate: squared_without_bound
                valid[n] = bounded[n] && raster::is_finite(next[n]);
                all_valid = all_valid && valid[n];
            }
        };

        /// Returns the second moment after a step. `weighted_square` is (1 - beta2) g^2.
        WARPAGG_HD real next_second(const real& v, const real& weighted_square) const {
            return constant<real>(beta2) * second_left * v + weighted_square;
        }
        static WARPAGG_HD real weighted_square(const real& g) { return constant<real>(1 - beta2) * g * g; }

        template <int N>
        WARPAGG_HD void step_with_floats(change<N>& by, parameter p, std::size_t k, std::size_t width) const {
            const place at = place_of(p);
            float *const first = at.array(of.moments.first), *const second = at.array(of.moments.second);
            const auto m = at.row.template load<N>(w, first, k, width);
            const auto v = at.row.template load<N>(w, second, k, width);
            WARPAGG_UNROLL
            for (int n = 0; n < N; ++n) {
                const real next_v = next_second(v[n], weighted_square(by.gradient[n]));
                by.compute(n, m[n], v[n], next_v);
                at.row.store(w, first, k, n, width, by.next_first[n], m[n], by.valid[n]);
                at.row.store(w, second, k, n, width, next_v, v[n], by.valid[n]);
                at.row.store(w, at.array(of.values), k, n, width, by.next[n], by.value[n], by.valid[n]);
            }
        }

        template <int N>
        WARPAGG_HD void step_with_pairs(change<N>& by, parameter p, std::size_t k, std::size_t width) const {
            using pair = moment_pair<real, word>;
            const auto words = row.template load<N>(w, of.moments.packed[p], k, width);
            WARPAGG_UNROLL
            for (int n = 0; n < N; ++n) {
                const pair before = pair::unpack(words[n]);
                const real next_v = next_second(before.second, weighted_square(by.gradient[n]));
                by.compute(n, before.first, before.second, next_v);
                const word after =
                    pair{by.next_first[n], next_v}.pack(random(p, k + static_cast<unsigned>(n)));
                row.store(w, of.moments.packed[p], k, n, width, after, words[n], by.valid[n]);
                row.store(w, of.values[p], k, n, width, by.next[n], by.value[n], by.valid[n]);
            }
        }

        /// For the three channels of an SH coefficient. SH degree 0 comes before the others.
        WARPAGG_HD void step_with_colors(change<3>& by, parameter p, std::size_t k, std::size_t width) const {
            using moments = color_moments<real, word>;
            const place at = place_of(p);
            std::uint32_t* const packed = at.array(of.moments.packed);
            const std::size_t slot = k / 3, words = p == parameter::sh0 ? 2 : width / 3;
            const word before = at.row.template load<1>(w, packed, slot, words)[0];
            word variance(0u);
            if (p == parameter::sh0) {
                variance = row.template load<1>(w, packed, 1, words)[0];
                color_before = raster::bits_of<real>(variance);
                const real square = glm::dot(by.gradient, by.gradient) * constant<real>(1.0 / 3);
                color_after = next_second(color_before, constant<real>(1 - beta2) * square);
            }
            const moments m = moments::unpack(before);
            const real root = color_before * inverse_root(color_before), inverse = inverse_root(color_after);
            moments after;
            WARPAGG_UNROLL
            for (int n = 0; n < 3; ++n) {
                by.compute(n, m.relative[n] * root, color_before, color_after);
                after.relative[n] = by.next_first[n] * inverse;
            }
            const mask_t<W> valid = by.all_valid;
            at.row.store(w, packed, slot, 0, words, after.pack(random(p, slot)), before, valid);
            if (p == parameter::sh0) {
                row.store(w, packed, 1, 0, words, raster::bits_of<word>(color_after), variance, valid);
                color_after = select(valid, color_after, color_before);
            }
            WARPAGG_UNROLL
            for (int n = 0; n < 3; ++n)
                at.row.store(w, at.array(of.values), k, n, width, by.next[n], by.value[n], valid);
        }

        using place = raster::row_place<W>;
        WARPAGG_HD place place_of(parameter p) const { return {row, p, cache_slot}; }

        /// Returns 1 / sqrt(v), where v may be zero.
        static WARPAGG_HD real inverse_root(const real& v) {
            return warpagg::math::inverse_sqrt(v + constant<real>(1e-36));
        }
        /// Returns random bits for a word of moments, different for each Gaussian, word and step.
        WARPAGG_HD word random(parameter p, std::size_t k) const {
            const std::uint32_t slot = static_cast<std::uint32_t>(p) * 8 + static_cast<std::uint32_t>(k);
            const word gaussian = word(w.lane()) + word(static_cast<std::uint32_t>(row.first));
            return counter_hash(gaussian, (of.step * 64 + slot) * 0x9e3779b1u);
        }

        template <int N>
        WARPAGG_HD void note(const change<N>& by, parameter p) const {
            using number = value_t<W, unsigned>;
            number gradients(0), parameters(0);
            WARPAGG_UNROLL
            for (int n = 0; n < N; ++n) {
                gradients += select(row.active && !by.bounded[n], number(1), number(0));
                parameters += select(row.active && by.bounded[n] && !by.valid[n], number(1), number(0));
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
        return {*this,
                w,
                row,
                first_left,
                second_left,
                constant<real>(9.0452374997021932) * (1 - r_left),
                row.cache_slot(values),
                real(0),
                real(0)};
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
