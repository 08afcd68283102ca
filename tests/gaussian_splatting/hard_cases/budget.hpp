// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace hard_cases {

/// Under sanitizers, which take ten times as long, the searches for wrong numbers are shorter.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool brief = true;
#else
inline constexpr bool brief = false;
#endif

}  // namespace hard_cases
