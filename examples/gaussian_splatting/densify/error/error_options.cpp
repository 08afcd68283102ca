// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../../options/option.hpp"
#include "error_config.hpp"

namespace gs::train {

std::vector<options::option> error_config::options() {
    return {{.names = "--error-views",
             .value = options::whole(views, 1, 1000000),
             .help = "Number of training views that are compared with their photos before each growth",
             .unit = "views"},
            {.names = "--error-level",
             .value = options::not_negative(level),
             .help = "Mean error of the color channels, of 1, above which a pixel counts as wrong"},
            {.names = "--error-pixels",
             .value = options::not_negative(pixels),
             .help = "Number of wrong pixels that a Gaussian shows in a mean view, from which it grows"}};
}

}  // namespace gs::train
