// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evidence.hpp"

namespace gs::effects {

/// An effect, and whether a scene calls for it.
struct decision {
    std::string name;
    std::optional<bool> called_for;  ///< none where too little tells
    std::string evidence;            ///< with its numbers
    std::string choice;              ///< what to do about it
};

/// From which evidence on an effect is called for.
struct thresholds {
    std::size_t points = 50;             ///< fewer of them say nothing
    double direction_share = 0.03;       ///< of the mean square that is unexplained, for each further degree
    double direction_amplitude = 0.002;  ///< and this root mean square, of full brightness
    double exposure = 0.1;               ///< see `evidence::exposure_spread`
    double exposure_errors = 3;          ///< times its standard error
    double scale_ratio = 2;
};

/// The degree of spherical harmonics that colours need: 0 to 3. Where too few points tell, 3.
int sh_degree(const evidence& e, const thresholds& limits = {});

/// All effects that are looked for.
std::vector<decision> decide(const evidence& e, const thresholds& limits = {});

}  // namespace gs::effects
