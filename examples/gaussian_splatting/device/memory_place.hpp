// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs::device {

/// The memory that holds a buffer. Kernels can use both. A GPU reaches host memory over its bus, which
/// takes longer.
enum class memory_place { device, host };

}  // namespace gs::device
