// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace gs::features {

/// The values of an effect that differs between lenses: see `lens_groups`. Each lens has `Width` of them.
template <unsigned Width>
struct lens_values {
    std::vector<int> lens_of_view;  ///< by training view, the index of its lens, or -1 for panoramas
    std::vector<float> parameters;  ///< `Width` for each lens

    lens_values(std::vector<int> lenses, std::vector<float> of_lenses)
        : lens_of_view(std::move(lenses)), parameters(std::move(of_lenses)) {}
    /// Reads the result of `flattened`. Precondition: there are as many training views.
    lens_values(const std::vector<float>& values, std::size_t views) {
        for (std::size_t v = 0; v < views; ++v) lens_of_view.push_back(static_cast<int>(values[v]));
        parameters.assign(values.begin() + static_cast<std::ptrdiff_t>(views), values.end());
    }

    std::vector<float> flattened() const {
        std::vector<float> values(lens_of_view.begin(), lens_of_view.end());
        values.insert(values.end(), parameters.begin(), parameters.end());
        return values;
    }
    /// Returns a pointer to the parameters of a lens.
    const float* of(int lens) const { return parameters.data() + static_cast<std::size_t>(lens) * Width; }
};

}  // namespace gs::features
