// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "harness.hpp"
#include "readers/polycam/polycam_camera.hpp"

bool gs_fuzz::polycam(std::string_view input) {
    return load_within_budget(input,
                              [](const std::filesystem::path& file) { gs::read_polycam_camera(file); });
}
