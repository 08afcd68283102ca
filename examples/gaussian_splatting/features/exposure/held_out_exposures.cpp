// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "held_out_exposures.hpp"

#include <algorithm>
#include <map>

namespace gs::features {
namespace {

exposure mean(const exposure& a, const exposure& b) {
    exposure m;
    for (std::size_t k = 0; k < m.size(); ++k) m[k] = 0.5f * (a[k] + b[k]);
    return m;
}

double square_distance(const exposure& a, const exposure& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double d = static_cast<double>(a[k] - b[k]);
        sum += d * d;
    }
    return sum;
}

/// Returns whether the mean of both neighbors predicts exposures better than the identity does.
/// `in_order`: the exposures of the photos in the order of their names.
bool neighbors_are_alike(const std::vector<exposure>& in_order) {
    double by_neighbors = 0, by_identity = 0;
    for (std::size_t i = 1; i + 1 < in_order.size(); ++i) {
        by_neighbors += square_distance(in_order[i], mean(in_order[i - 1], in_order[i + 1]));
        by_identity += square_distance(in_order[i], identity_exposure);
    }
    return by_neighbors < by_identity;
}

}  // namespace

std::vector<exposure> held_out_exposures(const scene& scene, const std::vector<exposure>& of_training) {
    std::map<std::string, exposure> by_name;
    for (std::size_t v = 0; v < of_training.size(); ++v) by_name[scene.train[v].name] = of_training[v];
    std::vector<exposure> in_order;
    for (const auto& [name, own] : by_name) in_order.push_back(own);
    std::vector<exposure> found(scene.test.size(), identity_exposure);
    if (!neighbors_are_alike(in_order)) return found;
    std::ranges::transform(scene.test, found.begin(), [&](const view& v) {
        const auto after = by_name.lower_bound(v.name);
        if (after == by_name.begin()) return after->second;
        const auto before = std::prev(after);
        return after == by_name.end() ? before->second : mean(before->second, after->second);
    });
    return found;
}

}  // namespace gs::features
