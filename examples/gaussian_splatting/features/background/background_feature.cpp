// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "background_feature.hpp"

#include <algorithm>

namespace gs::features {

explanation background_feature::explain(const scene_statistics& statistics, const finding& found) const {
    explanation made{.condition = "a photo has transparent parts"};
    const std::vector<view>& views = statistics.scene().train;
    const auto transparent = std::ranges::find_if(views, [](const view& v) { return v.pixels.has_alpha; });
    if (transparent != views.end())
        made.photos.push_back(
            shown_photo(*transparent, "Transparent photo", "The checkerboard marks transparent parts."));
    made.options = {found.choice == "white" ? "--background black" : "--background white"};
    return made;
}

}  // namespace gs::features
