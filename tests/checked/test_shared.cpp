// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What a block finds in its shared arrays: nothing that it could take for values, whoever was there before.

#include <cmath>

#include "../support/diagnoses.hpp"

TEST_SUITE_BEGIN("checked");

TEST_CASE("a block finds NaN in its shared arrays, and no zeros") {
    is_clean({.blocks = 3}, [](const checked& w) {
        const watched<float> floats = w.shared<float>(32);
        const watched<unsigned> integers = w.shared<unsigned>(32);
        CHECK(std::isnan(static_cast<float>(floats[w.lane()])));
        CHECK(static_cast<unsigned>(integers[w.lane()]) == 0xffffffffu);
        w.sync();
        floats[31 - w.lane()] = 0;
        integers[31 - w.lane()] = 0;
    });
}

TEST_SUITE_END();
