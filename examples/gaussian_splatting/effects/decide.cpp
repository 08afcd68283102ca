// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "decide.hpp"

#include <cmath>
#include <cstdio>

namespace gs::effects {
namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
    char line[200];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

bool tells_direction(const evidence& e, const thresholds& limits) {
    return e.points >= limits.points && e.unexplained[0] > 0;
}

decision view_dependent_colour(const evidence& e, const thresholds& limits) {
    const int degree = sh_degree(e, limits);
    const std::string choice = "--sh-degree " + std::to_string(degree);
    if (!tells_direction(e, limits))
        return {"view-dependent colour", true,
                "no telling: too few points lie in smooth parts of 5 photos that were taken from about one "
                "distance",
                choice};
    const auto up_to = static_cast<std::size_t>(degree == 0 ? 3 : degree);
    const double gone = e.unexplained[0] - e.unexplained[up_to];
    return {"view-dependent colour", degree > 0,
            text("degree %zu explains %.0f %% of %.1f %% by which photos of a point differ", up_to,
                 100 * std::max(gone, 0.0) / e.unexplained[0], 100 * std::sqrt(e.unexplained[0])),
            choice};
}

decision exposure(const evidence& e, const thresholds& limits) {
    if (e.points < limits.points)
        return {"exposure by photo", false,
                text("no telling: %zu points lie in smooth parts of 5 photos or more", e.points),
                "as they are"};
    const bool varies = e.exposure_spread >= limits.exposure &&
                        e.exposure_spread >= limits.exposure_errors * e.exposure_error;
    return {"exposure by photo", varies,
            text("the same points differ by %.2f stops between photos, measured to %.2f", e.exposure_spread,
                 e.exposure_error),
            varies ? "called for, but not simulated" : "as they are"};
}

decision antialiasing(const evidence& e, const thresholds& limits) {
    const bool spreads = e.scale_ratio >= limits.scale_ratio;
    return {"antialiasing", spreads,
            text("a point is up to %.1f times as large in one photo as in another", e.scale_ratio),
            spreads ? "called for, but not simulated" : "off"};
}

decision background(const evidence& e) {
    return {"background", e.alpha, e.alpha ? "photos have transparent parts" : "all photos are opaque",
            e.alpha ? "white" : "black"};
}

}  // namespace

int sh_degree(const evidence& e, const thresholds& limits) {
    if (!tells_direction(e, limits)) return 3;
    std::size_t degree = 0;
    for (std::size_t d = 1; d < e.unexplained.size(); ++d) {
        const double gone = e.unexplained[degree] - e.unexplained[d];
        const double amplitude = limits.direction_amplitude;
        if (gone >= limits.direction_share * e.unexplained[0] && gone >= amplitude * amplitude) degree = d;
    }
    return static_cast<int>(degree);
}

std::vector<decision> decide(const evidence& e, const thresholds& limits) {
    return {view_dependent_colour(e, limits), exposure(e, limits), antialiasing(e, limits), background(e)};
}

}  // namespace gs::effects
