// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace gs {

/// Receives lines for the user: what was resized, undistorted or dropped.
using log_function = std::function<void(const std::string&)>;

}  // namespace gs
