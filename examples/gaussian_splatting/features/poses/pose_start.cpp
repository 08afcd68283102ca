// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "pose_start.hpp"

#include <algorithm>

namespace gs::features {

std::vector<float> initial_values(const std::vector<given_pose>& given,
                                  const std::vector<pose_start>& starts) {
    std::vector<float> values;
    for (std::size_t v = 0; v < given.size(); ++v) {
        const auto numbers = numbers_of(given[v]);
        values.insert(values.end(), numbers.begin(), numbers.end());
        values.insert(values.end(), starts[v].change.begin(), starts[v].change.end());
        values.push_back(starts[v].largest_step);
    }
    return values;
}

std::vector<pose_start> starts_in(const std::vector<float>& values) {
    std::vector<pose_start> starts(values.size() / start_width);
    for (std::size_t v = 0; v < starts.size(); ++v) {
        const float* numbers = values.data() + v * start_width + given_width;
        std::copy_n(numbers, pose_width, starts[v].change.begin());
        starts[v].largest_step = numbers[pose_width];
    }
    return starts;
}

}  // namespace gs::features
