// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "evaluation/held_out_views.hpp"

TEST_CASE("images have flat names, and no two the same") {
    std::vector<gs::view> views(6);
    const char* names[] = {"a/b.jpg", "a_b.jpg", "x.jpg", "x.png", "IMG.0001", "IMG.0002"};
    for (std::size_t i = 0; i < 6; ++i) views[i].name = names[i];
    CHECK(gs::evaluate::render_names(views) == std::vector<std::string>{"a_b.png", "a_b.jpg_2.png", "x.png",
                                                                        "x.png_2.png", "IMG.png",
                                                                        "IMG.0002_2.png"});
}
