// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Charge deposit of a particle-in-cell code, cloud in cell: a particle's charge goes to the eight nodes of
/// its cell by trilinear weights. Particles of one cell add to the same eight nodes.

#include "common/compare.hpp"
#include "common/data.hpp"

using namespace warpagg;

/// Corner i of the cell whose lowest node is `node`, in a grid of `side`^3 nodes.
struct corners {
    float* charge;
    unsigned side;
    WARPAGG_HD float* operator()(unsigned node, unsigned i) const {
        return charge + node + (i & 1) + (i >> 1 & 1) * side + (i >> 2) * side * side;
    }
};

template <class Policy>
struct charge_deposit {
    const float *x, *y, *z;  // in cells
    unsigned n;
    corners grid;

    WARPAGG_HD unsigned lanes() const { return n; }

    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned first) const {
        const auto active = w.lane() + first < n;
        const value_t<W, float> at[3] = {w.load_row(x, first, active), w.load_row(y, first, active),
                                         w.load_row(z, first, active)};
        value_t<W, unsigned> node{};
        value_t<W, float> weight[3][2];  // of the lower and the upper node of each axis
        for (int axis = 2; axis >= 0; --axis) {
            const auto cell = math::convert<unsigned>(at[axis]);
            node = node * grid.side + cell;
            weight[axis][1] = at[axis] - math::convert<float>(cell);
            weight[axis][0] = 1.0f - weight[axis][1];
        }
        value_t<W, float> charge[8];
        for (int i = 0; i < 8; ++i) charge[i] = weight[0][i & 1] * weight[1][i >> 1 & 1] * weight[2][i >> 2];
        warp_match_reduce_atomic(w, grid, node, charge, active, Policy{});
    }
};

struct particle {
    float at[3];
};

unsigned cell_of(const particle& p, unsigned side) {
    unsigned node = 0;
    for (int axis = 2; axis >= 0; --axis) node = node * side + static_cast<unsigned>(p.at[axis]);
    return node;
}

int main(int argc, char** argv) {
    return example::run("Charge deposit", "particles, 64 a cell", argc, argv, [](unsigned n) {
        const unsigned cells = static_cast<unsigned>(std::cbrt(n / 64.0)), side = cells + 1;
        example::machine::array<float> charge(side * side * side);

        const auto deposit = [&](const char* name, const std::vector<particle>& particles) {
            example::exact_sums expected(side * side * side, 0x1p-9);
            std::vector<float> axes[3];
            for (const particle& p : particles) {
                for (int axis = 0; axis < 3; ++axis) axes[axis].push_back(p.at[axis]);
                for (unsigned i = 0; i < 8; ++i) {
                    double weight = 1;
                    unsigned node = cell_of(p, side);
                    for (unsigned axis = 0, stride = 1; axis < 3; ++axis, stride *= side) {
                        const double upper = p.at[axis] - std::floor(p.at[axis]);
                        weight *= (i >> axis & 1) != 0 ? upper : 1 - upper;
                        node += (i >> axis & 1) * stride;
                    }
                    expected.add(node, weight);
                }
            }
            example::machine::array<float> x(axes[0]), y(axes[1]), z(axes[2]);
            example::compare(name, charge, expected.values(), [&](auto policy) {
                return charge_deposit<decltype(policy)>{
                    x.data(), y.data(), z.data(), n, {charge.data(), side}};
            });
        };

        // Positions in eighths of a cell, whose weights are exact.
        std::vector<particle> particles(n);
        for (particle& p : particles)
            for (float& a : p.at) a = static_cast<float>(example::random_below(8 * cells)) / 8.0f;
        deposit("shuffled", particles);
        std::sort(particles.begin(), particles.end(),
                  [&](const particle& a, const particle& b) { return cell_of(a, side) < cell_of(b, side); });
        deposit("sorted by cell", particles);
        for (particle& p : particles)  // by up to a quarter of a cell along each axis
            for (float& a : p.at)
                a = std::clamp(a + (static_cast<float>(example::random_below(5)) - 2.0f) / 8.0f, 0.0f,
                               static_cast<float>(cells) - 0.125f);
        deposit("sorted, then moved", particles);
    });
}
