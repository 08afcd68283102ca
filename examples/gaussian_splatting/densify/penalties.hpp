// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../optimize/adam.hpp"
#include "strategy.hpp"

namespace gs::train {

/// Lowers opacities and scales, so that Gaussians that no view needs fade away. One index per
/// Gaussian.
///
/// The penalties do not change Adam's moments, like weight decay in AdamW (Loshchilov and Hutter
/// 2019): a value moves by its learning rate times the ratio of the penalty's gradient to the root
/// of the second moment, and at most by a tenth of its learning rate. Gaussians that the views need
/// have large second moments and hardly move. The moments of Gaussians that no view shows decay.
struct lower_by_penalty {
    parameter_arrays<float> values;
    moment_arrays moments;
    const std::uint32_t* last_step;  ///< last step that updated each Gaussian
    std::uint32_t step;              ///< number t of this step
    float correction;                ///< 1 / (1 - beta2^t) for the second moments
    float opacity_rate, scale_rate;  ///< learning rates
    float opacity_gradient;          ///< gradient of the penalty by an opacity
    float scale_gradient;            ///< gradient of the penalty by a scale
    raster::list_capacity capacity;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (capacity.exceeded()) return;
        // Adam decays the moments of a Gaussian only when a view shows it again. The factor is
        // log2 of beta2.
        const float missed = static_cast<float>(step) - static_cast<float>(last_step[i]);
        const float left = warpagg::math::exp2(-0.0014434168696687186f * missed) * correction;
        const float o = sigmoid(values.opacity[i]);
        lower(values.opacity[i], left * moments.second_of(parameter::opacity, i), opacity_rate,
              opacity_gradient * o * (1 - o));
        if (scale_gradient == 0) return;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t at = aosoa_index(i, k, 3);
            float& log_scale = values.log_scale[at];
            lower(log_scale, left * moments.second_of(parameter::log_scale, at), scale_rate,
                  scale_gradient * glm::exp(log_scale));
        }
    }

  private:
    WARPAGG_HD void lower(float& value, float second_moment, float rate, float gradient) const {
        constexpr float most = 0.1f;  // slow enough for new Gaussians that no view has shown yet
        const float root = warpagg::math::inverse_sqrt(second_moment + 1e-30f);
        const float lowered = value - rate * warpagg::math::min(gradient * root, most);
        if (raster::is_finite(lowered)) value = lowered;
    }
};

/// The weights of the mean opacity and of the mean scale, relative to the extent of the scene, beside
/// a loss that is a mean over pixels.
struct penalty_weights {
    double opacity = 0, scale = 0;
};

/// Runs `lower_by_penalty` on the Gaussians of this rank, unless both weights are zero.
template <device::device Device>
void apply_penalties(const penalty_weights& weights, double extent, int iteration,
                     const step_context<Device>& c) {
    if (weights.opacity == 0 && weights.scale == 0) return;
    const auto count = static_cast<double>(c.count);
    const double left = std::pow(adam<float>::beta2, iteration);
    c.device.for_each_index(
        c.own,
        lower_by_penalty{c.parameters.values.write(), c.parameters.moments(), c.parameters.last_step.data(),
                         static_cast<std::uint32_t>(iteration), static_cast<float>(1 / (1 - left)),
                         c.rates[static_cast<std::size_t>(parameter::opacity)],
                         c.rates[static_cast<std::size_t>(parameter::log_scale)],
                         static_cast<float>(weights.opacity / count),
                         static_cast<float>(weights.scale / (3 * count * extent)), c.capacity});
}

}  // namespace gs::train
