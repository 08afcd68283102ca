// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Which groups `packed<K>` commits and when it applies, on a model of one lane that writes them down. On a
/// GPU nothing can be seen of them but the sums.

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/serial.hpp>

namespace {

using warpagg::policy;
namespace reduce = warpagg::reduce;
namespace commit = warpagg::commit;
namespace gate = warpagg::gate;

struct packing : warpagg::emulator::serial {
    std::vector<unsigned>* groups;  ///< the sizes of those committed so far

    template <unsigned K>
    bool packs(const float* to) const {
        return reinterpret_cast<std::uintptr_t>(to) % (K * sizeof(float)) == 0;
    }
    template <unsigned K>
    void atomic_add_packed(warpagg::operation::sum, float* to, const float* v, bool active) const {
        if (!active) return;
        groups->push_back(K);
        for (unsigned i = 0; i < K; ++i) to[i] += v[i];
    }
};

using sizes = std::vector<unsigned>;

/// The groups in which 1, 2, ..., N reach a record that lies `offset` floats past an address aligned to four.
template <int N, class Policy>
sizes groups(unsigned offset) {
    sizes made;
    packing w;
    w.groups = &made;
    alignas(16) float memory[16] = {};
    float values[N];
    for (int i = 0; i < N; ++i) values[i] = static_cast<float>(i + 1);
    warpagg::warp_reduce_atomic(w, memory + offset, values, true, Policy{});
    for (unsigned i = 0; i < 16; ++i) {
        INFO("N = ", N, ", offset ", offset, ", component ", i);
        const bool within = i >= offset && i < offset + N;
        CHECK(memory[i] == (within ? static_cast<float>(i - offset + 1) : 0.0f));
    }
    return made;
}
template <int N, unsigned K>
sizes groups_of(unsigned offset = 0) {
    const sizes made = groups<N, policy<reduce::shfl_down, commit::packed<K>>>(offset);
    CHECK(made == groups<N, policy<reduce::butterfly, commit::packed<K>>>(offset));
    CHECK(made == groups<N, policy<reduce::per_lane, commit::packed<K>>>(offset));
    return made;
}

/// The groups in which 1, 2, ..., N reach the record of key 2, of those that begin `offset` floats past an
/// address aligned to four.
template <int N, class Policy>
sizes groups_by_key(unsigned offset = 0) {
    sizes made;
    packing w;
    w.groups = &made;
    alignas(16) float memory[3 * N + 4] = {};
    float values[N];
    for (int i = 0; i < N; ++i) values[i] = static_cast<float>(i + 1);
    warpagg::warp_match_reduce_atomic(w, memory + offset, 2, values, true, Policy{});
    for (unsigned i = 0; i < 3 * N + 4; ++i) {
        INFO("N = ", N, ", offset ", offset, ", component ", i);
        const unsigned first = offset + 2 * N;
        const bool within = i >= first && i < first + N;
        CHECK(memory[i] == (within ? static_cast<float>(i - first + 1) : 0.0f));
    }
    return made;
}

}  // namespace

TEST_SUITE_BEGIN("packed");

TEST_CASE("groups of K, and what is left by smaller ones") {
    CHECK(groups_of<1, 4>() == sizes{1});
    CHECK(groups_of<2, 4>() == sizes{2});
    CHECK(groups_of<3, 4>() == sizes{2, 1});
    CHECK(groups_of<4, 4>() == sizes{4});
    CHECK(groups_of<9, 4>() == sizes{4, 4, 1});
    CHECK(groups_of<11, 4>() == sizes{4, 4, 2, 1});
    CHECK(groups_of<1, 2>() == sizes{1});
    CHECK(groups_of<4, 2>() == sizes{2, 2});
    CHECK(groups_of<9, 2>() == sizes{2, 2, 2, 2, 1});
}

TEST_CASE("a record that is not aligned to K floats is committed one by one") {
    for (const unsigned offset : {1u, 2u, 3u, 5u}) CHECK(groups_of<9, 4>(offset).empty());
    CHECK(groups_of<9, 4>(4) == sizes{4, 4, 1});
    for (const unsigned offset : {1u, 3u, 5u}) CHECK(groups_of<9, 2>(offset).empty());
    for (const unsigned offset : {2u, 4u, 6u}) CHECK(groups_of<9, 2>(offset) == sizes{2, 2, 2, 2, 1});
}

TEST_CASE("an accessor, and other types than float, go one by one") {
    sizes made;
    packing w;
    w.groups = &made;
    alignas(16) float memory[4] = {};
    const float values[4] = {1, 2, 3, 4};
    const auto reversed = [&](unsigned i) { return memory + 3 - i; };
    warpagg::warp_reduce_atomic(w, reversed, values, true, policy{warpagg::packed<4>});
    CHECK(memory[0] == 4);
    CHECK(memory[3] == 1);
    alignas(16) int integers[4] = {};
    const int ones[4] = {1, 1, 1, 1};
    warpagg::warp_reduce_atomic(w, integers, ones, true, policy{warpagg::packed<4>});
    CHECK(integers[3] == 1);
    CHECK(made.empty());
}

TEST_CASE("a gate has a second threshold where packed<4> applies") {
    using second_is_higher = policy<reduce::scatter, gate::at_least<1, 2>>;
    using first_is_higher = policy<reduce::scatter, gate::at_least<2, 1>>;
    CHECK(groups<4, second_is_higher>(0) == sizes{4});  // one lane is too few: by itself, which is packed
    CHECK(groups<4, second_is_higher>(1).empty());
    CHECK(groups<4, first_is_higher>(0).empty());  // reduced
    CHECK(groups<4, first_is_higher>(1).empty());
}

TEST_CASE("records by key go by fours or twos where all are aligned to them") {
    using alone = policy<reduce::per_lane, commit::packed<4>>;
    using by_twos = policy<reduce::per_lane, commit::packed<2>>;
    CHECK(groups_by_key<4, alone>() == sizes{4});
    CHECK(groups_by_key<8, alone>() == sizes{4, 4});
    CHECK(groups_by_key<6, alone>().empty());  // every other record is not aligned to four
    CHECK(groups_by_key<6, by_twos>() == sizes{2, 2, 2});
    CHECK(groups_by_key<6, by_twos>(2) == sizes{2, 2, 2});
    CHECK(groups_by_key<6, by_twos>(1).empty());
    CHECK(groups_by_key<4, alone>(2).empty());
    CHECK(groups_by_key<5, alone>().empty());
    CHECK(groups_by_key<4, policy<>>() == sizes{4});
    CHECK(groups_by_key<6, policy<>>() == sizes{2, 2, 2});
    CHECK(groups_by_key<4, policy<reduce::per_lane>>().empty());  // no more than it says
}

TEST_SUITE_END();
