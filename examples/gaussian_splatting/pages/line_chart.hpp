// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gs::pages {

/// A curve. Points that are not finite are left out.
struct curve {
    std::string label;
    std::vector<std::pair<double, double>> points;
};

struct line_chart {
    std::string title;    ///< what the curves show, with its unit
    std::string x_title;  ///< the same for the horizontal axis
    std::vector<curve> curves;
    bool begins_at_zero = false;  ///< whether the vertical axis begins at zero
};

/// Returns an SVG element with axes and curves. The horizontal axis begins at zero. Curve i has the CSS class
/// "curve<i % 8>". A chart of several curves has their labels. Returns an empty text if no curve has points.
std::string svg_of(const line_chart& chart);

/// Returns a number for people, such as 0.0123, 27.4 or 1.25M.
std::string short_number(double value);

}  // namespace gs::pages
