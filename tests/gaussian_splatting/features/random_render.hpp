// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace gs_test {

/// Returns values from 0 to 1, as of an image.
inline std::vector<float> random_render(std::mt19937& random, std::size_t values) {
    std::vector<float> render(values);
    for (float& x : render) x = static_cast<float>(random() % 1000) / 999;
    return render;
}

}  // namespace gs_test
