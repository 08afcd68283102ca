// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <vector>

#include "device/cpu/cpu.hpp"
#include "render/renderer.hpp"

/// A model in AoSoA layout, in any precision.
template <class Real>
struct model {
    static constexpr std::size_t count = 45;
    static constexpr int sh_degree = 2;
    std::array<std::vector<Real>, gs::parameter_count> values;

    model() {
        std::mt19937 random(7);
        std::normal_distribution<double> normal;
        for (std::size_t p = 0; p < gs::parameter_count; ++p) {
            if (!gs::has_parameter(p, sh_degree)) continue;
            const auto width = static_cast<std::size_t>(gs::parameter_width[p]);
            std::vector<Real> rows;
            for (std::size_t i = 0; i < count * width; ++i) {
                const double x = normal(random);
                // Rounded to float, so that both precisions have the same model.
                rows.push_back(static_cast<Real>(static_cast<float>(p == 0   ? 0.7 * x
                                                                    : p == 1 ? -1.8 + 0.4 * x
                                                                    : p > 4  ? 0.2 * x
                                                                             : x)));
            }
            values[p] = gs::to_blocks(rows.data(), count, width, width);
        }
    }
    gs::parameter_arrays<const Real> read() const {
        gs::parameter_arrays<const Real> all;
        all.mean = values[0].data();
        all.log_scale = values[1].data();
        all.quaternion = values[2].data();
        all.opacity = values[3].data();
        for (std::size_t k = 0; k < 4; ++k) all.sh[k] = values[4 + k].data();
        return all;
    }
};

template <class Real>
struct drawing {
    gs::device::cpu device;
    model<Real> gaussians;
    gs::raster::renderer<gs::device::cpu, Real> renderer{device};

    explicit drawing(bool antialiased) {
        renderer.set_effects({.antialiasing = antialiased});
        renderer.reserve_instances(1u << 16);
    }
    const Real* draw(const gs::camera& c) {
        renderer.forward(gaussians.read(), model<Real>::count, c, model<Real>::sh_degree, {0.1f, 0.2f, 0.3f});
        return renderer.render();
    }
};
