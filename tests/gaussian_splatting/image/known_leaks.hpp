// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// Tells LeakSanitizer which memory other libraries lose: x265 when it encodes, and libheif 1.15 with
/// dav1d when an AVIF image is damaged. Include it in one source file of a program.
extern "C" const char* __lsan_default_suppressions();

const char* __lsan_default_suppressions() { return "leak:libx265\nleak:libdav1d\nleak:heif_image_create\n"; }
