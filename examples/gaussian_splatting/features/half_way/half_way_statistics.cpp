// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "half_way_statistics.hpp"

namespace gs::features {

const lens_falloff& half_way_statistics::falloff() const {
    if (falloff_) return *falloff_;
    observed_points all = compared_.smooth;
    all.insert(all.end(), compared_.sky.begin(), compared_.sky.end());
    falloff_ = estimate_falloff(scene_, std::move(all));
    return *falloff_;
}

const tone_response& half_way_statistics::response() const {
    if (response_) return *response_;
    observed_points smooth = compared_.smooth;
    if (falloff().is_clear()) remove_falloff(scene_, falloff(), smooth);
    response_ = estimate_response(scene_, std::move(smooth));
    return *response_;
}

observed_points half_way_statistics::parts() const {
    observed_points parts = compared_.all;
    if (falloff().is_clear()) remove_falloff(scene_, falloff(), parts);
    return parts;
}

}  // namespace gs::features
