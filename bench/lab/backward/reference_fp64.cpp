// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <random>

#include "device/cpu/cpu.hpp"
#include "model/parameter_memory.hpp"
#include "ranking.hpp"
#include "render/renderer.hpp"

namespace gs::lab {

std::vector<float> render_gradient(const ranking_setup& c) {
    std::mt19937_64 random(c.seed);
    std::normal_distribution<float> normal;
    const gs::camera& first = c.cameras.front();
    std::vector<float> gradient(3 * static_cast<std::size_t>(first.width) *
                                static_cast<std::size_t>(first.height));
    for (float& g : gradient) g = normal(random);
    return gradient;
}

std::size_t compared_views(const ranking_setup& c) { return std::min<std::size_t>(c.cameras.size(), 3); }

std::vector<std::vector<double>> sums_in_fp64(const ranking_setup& c) {
    using device = gs::device::basic_cpu<warpagg::emulator::serial>;
    device d;
    gs::parameter_memory<device> model;
    model.upload(d, c.model);
    std::array<std::vector<double>, gs::parameter_count> a;
    for (std::size_t p = 0; p < a.size(); ++p)
        a[p].assign(model[p].data(), model[p].data() + model[p].size());
    const gs::parameter_arrays<const double> arrays{a[0].data(),
                                                    a[1].data(),
                                                    a[2].data(),
                                                    a[3].data(),
                                                    {a[4].data(), a[5].data(), a[6].data(), a[7].data()}};
    const std::vector<float> in_float = render_gradient(c);
    const std::vector<double> gradient(in_float.begin(), in_float.end());

    gs::raster::renderer<device, double> renderer(d);
    std::vector<std::vector<double>> all;
    for (std::size_t v = 0; v < compared_views(c); ++v) {
        renderer.measure(arrays, c.model.count(), c.cameras[v], 0);
        renderer.reserve_instances(renderer.instances());
        renderer.forward(arrays, c.model.count(), c.cameras[v], c.model.sh_degree, c.background);
        using cut = gs::raster::cut_for<device::warp>;
        gs::raster::product_accumulators::with_kernel<double, cut>(gs::accumulator::native, [&](auto kernel) {
            const auto& sums = renderer.blend_backward_by(kernel, gradient.data(), 0);
            all.emplace_back(sums.data(), sums.data() + sums.size());
        });
    }
    return all;
}

}  // namespace gs::lab
