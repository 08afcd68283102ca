// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../../options/option.hpp"
#include "mcmc_config.hpp"

namespace gs::train {

std::vector<options::option> mcmc_config::options() {
    return {{.names = "--mcmc-noise",
             .value = options::not_negative(noise),
             .help = "Strength of the noise that moves transparent Gaussians in each iteration"},
            {.names = "--mcmc-opacity-penalty",
             .value = options::not_negative(opacity_penalty),
             .help = "Strength of the penalty on opacities, as a weight of their mean beside the loss"},
            {.names = "--mcmc-scale-penalty",
             .value = options::not_negative(scale_penalty),
             .help = "Strength of the penalty on scales, as a weight of their mean, relative to the "
                     "scene's extent, beside the loss"}};
}

}  // namespace gs::train
