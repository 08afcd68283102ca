// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace gs {

/// An error that the user can correct, such as bad input, a bad option or a full disk. `what()` is
/// one clear sentence that names the file, line or value. The program prints it after "error: " and
/// exits with a non-zero status.
struct error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace gs
