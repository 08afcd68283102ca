// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "../../image/image.hpp"
#include "synthetic_parameters.hpp"

namespace gs {

/// Paints or masks a disc of one color at a random place of one photo. It stands for a passer-by in
/// front of the scene.
void paint_passer(const synthetic_parameters& how, std::size_t photo, bool masks, image& pixels);

/// Paints a striped disc, if this is one of the photos that have one. It stands for a thing that moves
/// while photos are taken. Its place in the middle half of the photo, its size and its colors are random.
/// `photo`: number of the training photo.
void paint_moving_thing(const synthetic_parameters& how, std::size_t photo, image& pixels);

}  // namespace gs
