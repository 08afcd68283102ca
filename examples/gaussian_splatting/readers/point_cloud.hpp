// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "../scene/scene.hpp"

namespace gs {

/// Reads the vertices of a PLY file, ascii or binary little-endian: x, y and z, and possibly red,
/// green and blue. Colors are integers from 0 to 255, or floats from 0 to 1. Points without color
/// are gray. Ignores other properties, and elements after the vertices.
///
/// Throws `error` with the file, and the vertex that is malformed. Checks the number of vertices
/// against the size of the file before it allocates memory.
std::vector<colored_point> read_point_cloud(const std::filesystem::path& file);

}  // namespace gs
