// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "../pages/line_chart.hpp"
#include "../pages/marked_photo.hpp"
#include "../scene/observations.hpp"

namespace gs::features {

/// The reasons for a finding, for a person who may overrule it.
struct explanation {
    std::string condition{};  ///< with its thresholds; follows "recommended if"
    std::vector<pages::line_chart> charts{};
    std::vector<pages::marked_photo> photos{};
    std::vector<std::string> options{};  ///< options of train that overrule it, besides --effects
};

/// Returns a photo of a scene for an explanation. Decodes it.
pages::marked_photo shown_photo(const view& of, std::string label, std::string note = {},
                                std::vector<pages::mark> marks = {});

/// Returns a ring around an observed point in its photo.
pages::mark ring_around(const observation& seen, int color = 0);

/// Returns a curve of one value per photo. Values that are not finite are left out.
pages::curve curve_of_photos(std::string label, const std::vector<double>& values);

/// Returns a horizontal line from zero to `end`.
pages::curve level_line(std::string label, double end, double value);

}  // namespace gs::features
