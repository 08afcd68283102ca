// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Sums of rows by key, as in the scatter and segment operations of graph networks.

#include "scatter_kernel.hpp"

namespace {

namespace reduce = warpagg::reduce;
using warpagg::policy;

template <class Policy>
struct by_key {
    template <int N>
    __device__ void operator()(warpagg::cuda_warp w, float* base, unsigned key, const float (&v)[N],
                               bool active) const {
        warpagg::warp_match_reduce_atomic(w, base, key, v, active, Policy{});
    }
};

template <int Width>
kernel_case with_rows_of(keys how, const char* input) {
    using memory = scatter_memory<Width>;
    const auto rows = std::make_shared<memory>(how);
    kernel_case of = memory::case_of("scatter", input, rows);
    of.variants = {
        memory::template variant_of<1>("plain atomics", rows, plain_atomics{}),
        memory::template variant_of<1>("default, 1 value per lane", rows, by_key<policy<>>{}),
    };
    if constexpr (Width >= 4) {
        using packed = policy<reduce::per_lane, warpagg::commit::packed<4>>;
        const auto add_fours = [&](const char* name, auto add) {
            of.variants.push_back(memory::template variant_of<4>(name, rows, add));
        };
        add_fours("default", by_key<policy<>>{});
        add_fours("per_lane", by_key<policy<reduce::per_lane>>{});
        add_fours("per_lane, packed<4>", by_key<packed>{});
    }
    return of;
}

}  // namespace

std::vector<kernel_maker> scatter_cases() {
    std::vector<kernel_maker> all;
    for (const auto& in : key_distributions) {
        all.push_back([=] { return with_rows_of<1>(in.how, in.name); });
        all.push_back([=] { return with_rows_of<4>(in.how, in.name); });
        all.push_back([=] { return with_rows_of<64>(in.how, in.name); });
    }
    return all;
}
