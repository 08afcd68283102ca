// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "harness.hpp"
#include "readers/opensfm/opensfm_files.hpp"

bool gs_fuzz::opensfm(std::string_view input) {
    return load_within_budget(
        input, [](const std::filesystem::path& file) { gs::read_opensfm_reconstructions(file); });
}
