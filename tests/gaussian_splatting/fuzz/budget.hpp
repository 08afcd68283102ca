// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace gs_fuzz {

/// Counts the bytes that this thread has allocated and not released, from its construction on, in libraries
/// too. It needs AddressSanitizer's allocator; elsewhere nothing is counted.
class budget {
  public:
    budget();
    ~budget();
    budget(const budget&) = delete;
    budget& operator=(const budget&) = delete;

    /// The most bytes that were live at once.
    std::size_t peak() const;

    static bool is_counting();  ///< whether this program has the allocator that it needs
};

}  // namespace gs_fuzz
