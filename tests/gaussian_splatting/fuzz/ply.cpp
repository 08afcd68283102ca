// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "writers/ply/ply.hpp"

#include "harness.hpp"

bool gs_fuzz::ply(std::string_view input) {
    return load_within_budget(input, [](const std::filesystem::path& file) { gs::read_ply(file); });
}
