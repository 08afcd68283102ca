// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "downsample.hpp"

#include <algorithm>

namespace gs {
namespace {

int divided(int side, int divisor) { return std::max(1, (2 * side + divisor) / (2 * divisor)); }

}  // namespace

camera downsampled(const camera& full, int divisor) {
    return full.resized(divided(full.width, divisor), divided(full.height, divisor));
}

view downsampled(const view& full, int divisor) {
    const camera small = downsampled(full.camera, divisor);
    return {full.name, small, downsample(full.pixels, small.width, small.height),
            resized(full.depths, small.width, small.height)};
}

}  // namespace gs
