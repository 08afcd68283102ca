// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <exception>
#include <vector>

#include "../photos/photo_stream.hpp"

namespace gs::train {

/// Streamed photos: photos that are decoded shortly before steps need them.
class photo_prefetch {
  public:
    virtual ~photo_prefetch() = default;

    /// Returns how many photos to `expect`.
    virtual std::size_t look_ahead() const = 0;
    /// Sets the photos of the next steps, in their order. Steps with other photos take longer.
    virtual void expect(std::vector<photos::photo_request> next) = 0;
    /// Returns the reason why a photo of the step after the next one cannot be decoded, or null. Waits
    /// until they are decoded. `of_step`: number of photos of a step.
    virtual std::exception_ptr failure_ahead(std::size_t of_step) = 0;
};

}  // namespace gs::train
