// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../writer.hpp"

namespace gs {

/// Binary glTF 2.0 files with the extension KHR_gaussian_splatting. All parameters are floats; opacities
/// and scales are stored without logit and logarithm. Colors without extension are in `COLOR_0`, so that
/// other programs can show points.
///
/// The axes are x right, y up, z backward; both functions turn the model about its x axis.
/// Antialiasing and a learned background are lost. The order of the Gaussians stays.
///
/// Reading takes the first primitive with the extension. It throws `error` with the file and the field
/// for: a chunk or an accessor that exceeds the file, an attribute that is missing or does not consist of
/// floats, nodes with a transformation, a value that is not finite, a negative scale, a rotation of zero.
/// JSON of more than 1 MiB is refused.
extern const writer gltf_writer;

}  // namespace gs
