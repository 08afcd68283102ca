// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "reader.hpp"

namespace gs {

/// Reads the scene `options.data` with the first reader whose `probe` accepts it, and loads its
/// images. `options.data` may also be a `.zip` archive of a scene: see `extracted_archive`. Messages
/// then name the archive in place of its temporary folder. `log` may be empty. Throws `error` if no
/// reader accepts the scene, if an option does not apply to it, if it has no training view, or if
/// `options.eval` is set but no view is held out.
scene load_scene(const load_options& options, const log_function& log,
                 std::span<const reader* const> readers = all_readers());

}  // namespace gs
