// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bounds.hpp"

namespace hard_cases {

enum class outcome { running, ok, failed };

/// The known facts about a test case.
struct row {
    std::string remarks;
    std::map<std::string, outcome> cells;             ///< by column
    std::map<std::string, agreement> against_double;  ///< by column, where it was measured
    bool has_variants = false;
    bool failed = false;  ///< outside of the cells
};

/// Of the run so far. Tests run one after another.
struct results {
    std::map<std::string, row> rows;  ///< by test case
    std::vector<std::string> order;   ///< of the test cases that have run
    std::vector<std::string> known;   ///< all test cases, those too that were not asked for
    std::string test, column;         ///< where we are; no column outside of a cell

    row& here() { return rows[test]; }
};

results& all_results();

/// A backend's own column, or that of one of its variants.
std::string column_of(const std::string& backend, const std::string& variant);

/// Prints the table of the test cases that ran, and writes it as JSON to the file that WARPAGG_CASES_JSON
/// names. Returns whether each of their cells is ok and each hard case has a test.
bool report();

}  // namespace hard_cases
