// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Gradient of an embedding: each token's gradient is added to the row of a table that the token names. The
/// more lanes share a row, the better memory is used; the fewer, the more tokens meet in a warp, where the
/// gradients of equal ones are summed first.

#include "common/compare.hpp"
#include "common/data.hpp"

using namespace warpagg;

constexpr unsigned width = 64;  // floats in a row
constexpr unsigned held = 8;    // floats of a row that a lane holds

/// A row in parts, one a lane. The `Lanes` that share a stretch of it take its floats in turns, so that they
/// read and add neighbors.
template <unsigned Lanes>
struct parts {
    static constexpr unsigned per_row = width / held;

    float* table;

    /// Where float k of a part lies in a table.
    template <class U>
    WARPAGG_HD static U offset(U part, unsigned k) {
        return part / Lanes * (Lanes * held) + part % Lanes + k * Lanes;
    }
    WARPAGG_HD float* operator()(unsigned part, unsigned k) const { return table + offset(part, k); }
};

template <unsigned Lanes, class Policy>
struct embedding_gradient {
    using parts = ::parts<Lanes>;
    static constexpr unsigned tokens_per_warp = 32 / Lanes, warps_per_token = parts::per_row / Lanes;

    const unsigned* tokens;
    const float* gradients;  // a row a token
    unsigned n;
    float* table;

    WARPAGG_HD unsigned lanes() const {
        return (n + tokens_per_warp - 1) / tokens_per_warp * warps_per_token * 32;
    }

    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned first) const {
        const auto lane = w.lane() + first;  // its token is number i, of whose row it holds this part
        const auto i = lane / 32u / warps_per_token * tokens_per_warp + lane % 32u / Lanes;
        const auto part = lane / 32u % warps_per_token * Lanes + lane % Lanes;
        const auto active = i < n;
        const auto token = w.load(tokens, i, active);
        value_t<W, float> values[held];
        for (unsigned k = 0; k < held; ++k)
            values[k] = w.load(gradients, parts::offset(i * parts::per_row + part, k), active);
        warp_match_reduce_atomic(w, parts{table}, token * parts::per_row + part, values, active, Policy{});
    }
};

int main(int argc, char** argv) {
    return example::run("Gradient of an embedding", "floats in rows of 64", argc, argv, [](unsigned n) {
        n /= width;
        constexpr unsigned words = 32768;
        std::vector<float> gradient(n * width);
        for (float& g : gradient) g = (static_cast<float>(example::random_below(17)) - 8.0f) / 8.0f;
        example::machine::array<float> gradients(gradient), table(words * width);

        const auto add = [&](const std::string& name, const std::vector<unsigned>& token) {
            example::exact_sums expected(words * width, 1.0 / 8);
            for (unsigned i = 0; i < n * width; ++i)
                expected.add(token[i / width] * width + i % width, gradient[i]);
            const std::vector<float> sums = expected.values();
            example::machine::array<unsigned> tokens(token);
            example::compare(name + ", 8 lanes a row", table, sums, [&](auto policy) {
                return embedding_gradient<8, decltype(policy)>{tokens.data(), gradients.data(), n,
                                                               table.data()};
            });
            example::compare(name + ", 1 lane a row", table, sums, [&](auto policy) {
                return embedding_gradient<1, decltype(policy)>{tokens.data(), gradients.data(), n,
                                                               table.data()};
            });
        };
        add("uniform", example::uniform(n, words));
        add("Zipf", example::zipf(n, words));
        std::vector<unsigned> batch = example::zipf(n, words);
        for (unsigned i = 0; i < n; ++i)  // sentences of 1 to 64 tokens, filled up to 64 with token 0
            if (i % 64 > i / 64 * 37 % 64) batch[i] = 0;
        add("padded batch", batch);
    });
}
