// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The version of the library, by Semantic Versioning; this is the one place where it is written.

/// One of the three numbers of the version.
/// @{
#define WARPAGG_VERSION_MAJOR 0
#define WARPAGG_VERSION_MINOR 1
#define WARPAGG_VERSION_PATCH 0
/// @}
