// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The update step of k-means on colors: per cluster, the sum of its pixels' red, green and blue, and their
/// number. The four lie in one record.

#include "common/compare.hpp"
#include "common/data.hpp"

using namespace warpagg;

template <class Policy>
struct add_to_clusters {
    const unsigned* colors;    // 0xbbggrr
    const unsigned* clusters;  // each pixel's
    unsigned n;
    unsigned* sums;  // red, green, blue, count

    WARPAGG_HD unsigned lanes() const { return n; }

    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned first) const {
        const auto active = w.lane() + first < n;
        const auto color = w.load_row(colors, first, active);
        const auto cluster = w.load_row(clusters, first, active);
        const value_t<W, unsigned> values[4] = {color & 255u, color >> 8u & 255u, color >> 16u & 255u, 1u};
        warp_match_reduce_atomic(w, sums, cluster, values, active, Policy{});
    }
};

/// Clusters as neighboring pixels have them: mostly the same.
std::vector<unsigned> render(unsigned n, unsigned clusters) {
    std::vector<unsigned> v = example::uniform(n, clusters);
    for (unsigned i = 1; i < n; ++i)
        if (example::random_below(8) != 0) v[i] = v[i - 1];
    return v;
}

int main(int argc, char** argv) {
    return example::run("k-means update", "pixels", argc, argv, [](unsigned n) {
        const std::vector<unsigned> color = example::uniform(n, 1u << 24);
        example::machine::array<unsigned> colors(color);

        const auto update = [&](const char* name, const std::vector<unsigned>& cluster, unsigned number) {
            std::vector<unsigned> expected(4 * number);
            for (unsigned i = 0; i < n; ++i) {
                for (unsigned c = 0; c < 3; ++c) expected[4 * cluster[i] + c] += color[i] >> 8 * c & 255u;
                ++expected[4 * cluster[i] + 3];
            }
            example::machine::array<unsigned> clusters(cluster), sums(4 * number);
            example::compare(name, sums, expected, [&](auto policy) {
                return add_to_clusters<decltype(policy)>{colors.data(), clusters.data(), n, sums.data()};
            });
        };
        update("8 clusters, noise", example::uniform(n, 8), 8);
        update("256 clusters, noise", example::uniform(n, 256), 256);
        update("256 clusters, an image", render(n, 256), 256);
    });
}
