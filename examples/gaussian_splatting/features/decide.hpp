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
    std::string expected;            ///< what it costs and gains: see docs/effects.md
};

/// The degree of spherical harmonics that colours need: 0 to 3. Where too few points tell, 3; but where next
/// to none of them does, 0: the photos are too few, or too far apart, to tell colours by direction from all
/// else.
int sh_degree(const evidence& e);

/// Whether enough points tell of it.
bool direction_is_known(const evidence& e);

inline constexpr const char* no_masks = "no mask leaves anything out of a training photo";

/// All effects that are looked for.
std::vector<decision> decide(const evidence& e);

}  // namespace gs::effects
