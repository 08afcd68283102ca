// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "run_program.hpp"

namespace gs_test {

inline const words small_spheres{"-d", "synthetic:spheres", "-r", "32", "--eval", "--device", "cpu"};

/// A training without an output folder.
inline const words train_spheres{"train", "-d", "synthetic:spheres"};

/// A training of 60 iterations, which takes about a second.
inline words small_training(const fs::path& output) {
    return words{"train", "-i", "60", "-o", output.string()} + small_spheres;
}

}  // namespace gs_test
