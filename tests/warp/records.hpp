// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// What needs no second value type: long records, NaN of active lanes, and `skip_if_warp_idle`; on the
/// `backend` that the including file has chosen.

#include "../reduce_atomic/checks.hpp"

namespace {

/// Notes each lane's answer of `skip_if_warp_idle` for every case.
struct ask_all {
    const unsigned* active;
    unsigned* answer;
    unsigned cases;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w) const {
        const mask_t<W> everyone(true);
        const auto lane = w.lane();
        for (unsigned c = 0; c < cases; ++c) {
            const mask_t<W> adds = w.load(active + c * W::size, lane, everyone) != 0u;
            const bool idle = warpagg::skip_if_warp_idle(w, adds);
            w.store(answer + c * W::size, lane, value_t<W, unsigned>(idle ? 1u : 0u), everyone);
        }
    }
};

/// More values than lanes, or nearly so: a lane holds several sums, or none.
template <int N>
void check_many() {
    const problem<float> p(N, records, 3);
    check<without_policy, N>(p, "no policy", as_chosen<float, N, policy<>>);
    check<with<policy<reduce::per_lane>>, N>(p, "per_lane", always_alone);
    check<with<policy<reduce::butterfly, commit::contiguous>>, N>(p, "butterfly contiguous", {});
    check<with<policy<reduce::scatter>>, N>(p, "scatter", {});
}

/// The NaN of an active lane is not hidden: it must reach its own component and no other.
template <class Call>
void check_poison_of_active_lanes(const char* what) {
    constexpr int n = 9;
    problem<float> p(n, records, 4);
    std::vector<bool> nan(p.before.size(), false);
    for (unsigned c = 0; c < p.cases; ++c) {
        const unsigned i = c % n;
        for (unsigned lane = 0; lane < width; ++lane)
            if (p.is_active(c, lane)) {
                p.values[(c * n + i) * width + lane] = std::numeric_limits<float>::quiet_NaN();
                nan[p.where.at(c, i)] = true;
            }
    }
    const auto after = memory_after<Call, n>(p);
    bool as_expected = true;
    for (unsigned c = 0; c < p.cases; ++c)
        for (unsigned i = 0; i < n; ++i) {
            const std::size_t cell = p.where.at(c, i);
            as_expected = as_expected && std::isnan(after[cell]) == nan[cell];
        }
    INFO(std::string(what));
    CHECK(as_expected);
}

}  // namespace

TEST_SUITE_BEGIN(backend::name);

TEST_CASE("records of more values than a warp has lanes") {
    constexpr int lanes = width;
    check_many<lanes>();
    check_many<lanes + 1>();
    check_many<lanes + 8>();
    check_same_bits<lanes + 8, float>();
}

TEST_CASE("a NaN of an active lane reaches its component and no other") {
    check_poison_of_active_lanes<without_policy>("default");
    check_poison_of_active_lanes<with<policy<reduce::shfl_down>>>("shfl_down");
    check_poison_of_active_lanes<with<policy<reduce::butterfly, commit::contiguous>>>("butterfly contiguous");
    check_poison_of_active_lanes<with<policy<reduce::per_lane>>>("per_lane");
}

TEST_CASE("skip_if_warp_idle answers alike in every lane") {
    const problem<float> p(1, records);
    backend::memory<unsigned> active(p.active);
    backend::memory<unsigned> answers(std::vector<unsigned>(p.active.size(), 7u));
    backend::launch(ask_all{active.data(), answers.data(), p.cases});

    const std::vector<unsigned> answer = answers.download();
    unsigned wrong = 0;
    for (unsigned c = 0; c < p.cases; ++c) {
        bool busy = false;
        for (unsigned lane = 0; lane < width; ++lane) busy = busy || p.is_active(c, lane);
        for (unsigned lane = 0; lane < width; ++lane) wrong += answer[c * width + lane] != (busy ? 0u : 1u);
    }
    CHECK(wrong == 0);
}

TEST_SUITE_END();
