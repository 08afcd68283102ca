// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "run_record.hpp"

namespace gs::pages {

/// A view that several runs have rendered.
struct compared_view {
    std::string name;
    std::string label;  ///< such as "Worst view"
    image photo;
    std::vector<image> renders;  ///< one per run, of the size of the photo
};

/// Writes a page about several runs: their metrics side by side, their curves in the same charts,
/// views with a slider between any two images, and the settings that differ. See
/// `write_report_page`. The runs have different names.
void write_compare_page(std::ostream& out, const std::vector<run_record>& runs,
                        const std::vector<compared_view>& views);

}  // namespace gs::pages
