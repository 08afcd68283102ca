// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs::device {

/// Whether a kernel wants memory that its warp's lanes share while it runs: it names the type,
/// `scratch<Warp>`, and gets one as its last argument, not initialised; in shared memory on a GPU.
template <class F, class Warp>
concept has_scratch = requires {
    typename F::template scratch<Warp>;
};

}  // namespace gs::device
