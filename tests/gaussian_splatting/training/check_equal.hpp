// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include "model/gaussians.hpp"

/// Checks that two models are equal bit for bit.
inline void check_equal(const gs::gaussians& a, const gs::gaussians& b) {
    CHECK(a.count() == b.count());
    CHECK(a.mean == b.mean);
    CHECK(a.log_scale == b.log_scale);
    CHECK(a.quaternion == b.quaternion);
    CHECK(a.opacity == b.opacity);
    CHECK(a.sh_constant == b.sh_constant);
    CHECK(a.sh_rest == b.sh_rest);
    CHECK(a.sky == b.sky);
}
