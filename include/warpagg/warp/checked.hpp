// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The checked model of `warp`, for unit tests: runs the lanes of a kernel as fibers on the CPU, in
/// an order drawn from a seed, and diagnoses misuse. POSIX; GCC 12 or clang 14 and later. To
/// diagnose more uses of undefined values, include fork_shadow_process.hpp in one source file.
///
/// @snippet checked.cpp kernel
/// @snippet checked.cpp launch
/// @snippet checked.cpp diagnosis

#include "checked/diagnosis.hpp"  // `report`, what `try_launch` returns
#include "checked/launch.hpp"     // `launch`, `try_launch`, `grid`
#include "checked/model.hpp"      // `checked`
#include "checked/seeds.hpp"      // `for_each_seed`
#include "checked/watched.hpp"    // `watched`, arrays whose accesses are seen
#include "concept.hpp"

static_assert(warpagg::warp<warpagg::emulator::checked>);
