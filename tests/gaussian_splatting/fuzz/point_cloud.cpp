// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "readers/point_cloud.hpp"

#include "harness.hpp"

bool gs_fuzz::point_cloud(std::string_view input) {
    // A point takes 32 bytes, but its text may have only six, as in "0 0 0".
    return load_within_budget(
        input, [](const std::filesystem::path& file) { gs::read_point_cloud(file); },
        [&] { return 2 * input.size(); });
}
