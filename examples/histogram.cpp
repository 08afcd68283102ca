// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Histogram of an image: pixels of one value that meet in a warp are counted first and added at once.

#include "common/compare.hpp"
#include "common/data.hpp"

using namespace warpagg;

template <class Policy>
struct histogram {
    const unsigned* pixels;
    unsigned n;
    unsigned* bins;

    WARPAGG_HD unsigned lanes() const { return n; }

    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned first) const {
        const auto active = w.lane() + first < n;
        const auto bin = w.load_row(pixels, first, active);
        const value_t<W, unsigned> count[1] = {1u};
        warp_match_reduce_atomic(w, bins, bin, count, active, Policy{});
    }
};

int main(int argc, char** argv) {
    return example::run("Histogram", "pixels of 12 bits", argc, argv, [](unsigned n) {
        constexpr unsigned values = 4096;
        example::machine::array<unsigned> bins(values);

        const auto count = [&](const char* name, const std::vector<unsigned>& image) {
            std::vector<unsigned> expected(values);
            for (const unsigned pixel : image) ++expected[pixel];
            example::machine::array<unsigned> pixels(image);
            example::compare(name, bins, expected, [&](auto policy) {
                return histogram<decltype(policy)>{pixels.data(), n, bins.data()};
            });
        };
        count("uniform", example::uniform(n, values));
        count("Zipf", example::zipf(n, values));
        count("constant", std::vector<unsigned>(n, values / 2));
    });
}
