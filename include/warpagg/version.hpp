// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The version of the library (Semantic Versioning). The build system reads it from here.

/// A component of the version number: major, minor or patch.
/// @{
#define WARPAGG_VERSION_MAJOR 0
#define WARPAGG_VERSION_MINOR 2
#define WARPAGG_VERSION_PATCH 0
/// @}
