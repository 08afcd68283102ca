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
             .help = "Weight of the mean opacity in the loss"},
            {.names = "--mcmc-scale-penalty",
             .value = options::not_negative(scale_penalty),
             .help = "Weight of the mean scale, relative to the scene's extent, in the loss"}};
}

}  // namespace gs::train
