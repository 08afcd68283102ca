// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace gs::cli {

/// Returns the word in `known` with the smallest Levenshtein distance from `word`, the first one if
/// several have it. Precondition: `known` is not empty.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace gs::cli
