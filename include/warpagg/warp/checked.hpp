// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The checked model of `warp`, for unit tests. It runs the lanes of a kernel as fibers on the CPU,
/// in an order drawn from a seed, and diagnoses misuse. It requires POSIX, and GCC 12 or clang 14 or
/// later. To diagnose more uses of undefined values, include fork_shadow_process.hpp in one source
/// file.
///
/// @snippet checked.cpp kernel
/// @snippet checked.cpp launch
/// @snippet checked.cpp diagnosis

#include "checked/diagnosis.hpp"  // `report`, the result of `try_launch`
#include "checked/launch.hpp"     // `launch`, `try_launch`, `grid`
#include "checked/model.hpp"      // `checked`, `wide_checked`
#include "checked/seeds.hpp"      // `for_each_seed`
#include "checked/watched.hpp"    // `watched`, arrays that are checked for races
#include "concept.hpp"

static_assert(warpagg::warp<warpagg::emulator::checked> && warpagg::warp<warpagg::emulator::wide_checked>);
