// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <vector>
#include <warpagg/simt/checked.hpp>

#include "first_try.hpp"

int main() {
    const std::vector<float> samples(100, 1.0f);
    float moments[3] = {};
    warpagg::emulator::launch({.blocks = 2, .threads = 64}, [&](const warpagg::emulator::checked& w) {
        const unsigned i = w.block_index() * w.block_size() + w.thread_index();
        add_moments(w, i, samples.data(), 100, moments);
    });
}
