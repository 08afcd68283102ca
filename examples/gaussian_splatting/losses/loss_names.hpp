// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace gs::train {

/// Returns the names of all losses, in the order of the list in losses.hpp.
std::vector<std::string> loss_names();

}  // namespace gs::train
