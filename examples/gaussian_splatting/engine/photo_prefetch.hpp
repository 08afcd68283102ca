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
    /// Returns the reason why the photo after the next one cannot be decoded, or null. Waits until it
    /// is decoded.
    virtual std::exception_ptr failure_ahead() = 0;
};

}  // namespace gs::train
