// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "readers/transforms/transforms.hpp"

#include "harness.hpp"

bool gs_fuzz::transforms(std::string_view input) {
    return load_within_budget(input, [](const std::filesystem::path& file) { gs::read_transforms(file); });
}
