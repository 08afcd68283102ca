// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace gs::cli {

/// The first of the `known` words with the smallest Levenshtein distance from `word`. Precondition: `known`
/// is not empty.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace gs::cli
