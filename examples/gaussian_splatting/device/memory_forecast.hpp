// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace gs::device {

/// The device memory that training is expected to need, in bytes.
struct memory_forecast {
    std::uint64_t photos = 0;
    std::uint64_t gaussians = 0;  ///< parameters, their gradients, and the state of the optimizer
    std::uint64_t others = 0;     ///< tile lists, and images of the size of a photo
    std::uint64_t on_host = 0;    ///< parameters that lie in host memory; not part of `total`

    std::uint64_t total() const { return photos + gaussians + others; }
};

}  // namespace gs::device
