// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace gs {

/// A function that receives messages for the user, such as which images were resized.
using log_function = std::function<void(const std::string&)>;

}  // namespace gs
