// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

namespace gs::device {

/// Is satisfied by warp kernels that need scratch memory, which the lanes of the warp share. Such a
/// kernel has a member type `scratch<Warp>`, and receives an uninitialized object of it as its last
/// argument. On a GPU the object is in shared memory.
template <class F, class Warp>
concept has_scratch = requires {
    typename F::template scratch<Warp>;
};

}  // namespace gs::device
