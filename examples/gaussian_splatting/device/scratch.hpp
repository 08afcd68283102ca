// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs::device {

/// Whether a warp kernel asks for memory that the lanes of its warp share while it runs. Such a
/// kernel names the type, `scratch<Warp>`, and gets an uninitialized object of it as its last
/// argument. On a GPU the object is in shared memory.
template <class F, class Warp>
concept has_scratch = requires {
    typename F::template scratch<Warp>;
};

}  // namespace gs::device
