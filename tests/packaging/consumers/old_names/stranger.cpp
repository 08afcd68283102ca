// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Uses the former headers and names, which are deprecated.
#include <cstddef>
#include <cstdio>
#include <vector>
#include <warpagg/accumulate/accumulate.hpp>
#include <warpagg/atomic.hpp>
#include <warpagg/commit/stage.hpp>
#include <warpagg/components.hpp>
#include <warpagg/match.hpp>
#include <warpagg/operation.hpp>
#include <warpagg/ordered.hpp>
#include <warpagg/simt/checked.hpp>
#include <warpagg/simt/counters.hpp>
#include <warpagg/simt/iterations.hpp>
#include <warpagg/simt/lanes.hpp>
#include <warpagg/simt/math.hpp>
#include <warpagg/simt/serial.hpp>
#include <warpagg/simt/simd.hpp>
#include <warpagg/simt/target.hpp>
#include <warpagg/simt/warp.hpp>

struct particle {
    float mass, momentum[2];
};
template <>
struct warpagg::components<particle> : warpagg::consists_of<float, 3> {};
static_assert(warpagg::composite<particle>);

namespace {

namespace accumulate = warpagg::accumulate;
const warpagg::emulator::serial serial;

/// The program of the README.
bool counts() {
    warpagg::emulator::counters did;
    warpagg::emulator::counted_lanes w{{&did}};
    const auto x = warpagg::convert<float>(w.lane());  // 0 to 31
    const warpagg::lanes<float, 32> values[2] = {x, x * x};
    float memory[2] = {};
    warpagg::warp_reduce_atomic(w, memory, values, x < 10.0f);
    return memory[0] == 45 && memory[1] == 285 && did.atomics == 2 && did.commits == 1 && did.votes == 2;
}

bool adds_components() {
    particle sum{};
    warpagg::warp_reduce_atomic(serial, &sum, particle{1, {2, 3}}, true);
    return sum.mass == 1 && sum.momentum[1] == 3;
}

bool adds_cells() {
    using kind = accumulate::between_warps<accumulate::exact>::kept;
    warpagg::cell<kind> sum{};
    const float value[1] = {2.5f};
    warpagg::warp_reduce_atomic(serial, &sum, value, true, warpagg::policy{warpagg::exact});
    kind::number numbers[kind::numbers];
    kind::split(2.5f, numbers);
    return sum.value() == 2.5f && kind::value(numbers) == 2.5f;
}

bool adds_in_order() {
    using pieces = warpagg::ordered_pieces<float>;
    static_assert(pieces::piece == 1024);
    const unsigned keys[3] = {0, 0, 1}, n = 3;
    const float values[3] = {1, 2, 4};
    float sums[2] = {};
    std::vector<unsigned> edge_keys(2 * pieces::pieces(n));
    std::vector<float> edge_sums(edge_keys.size());
    pieces{keys, values, n, sums, edge_keys.data(), edge_sums.data()}(serial, 0);
    const warpagg::ordered_join<float> join{edge_keys.data(), edge_sums.data(), edge_keys.size(), sums};
    for (std::size_t edge = 0; edge < edge_keys.size(); ++edge) join(edge);
    return sums[0] == 3 && sums[1] == 4;
}

bool reduces() {
    static_assert(warpagg::reduce::results_in::spread == warpagg::reduce::result_placement::spread);
    float results[1] = {};
    warpagg::reduce::over_warp<warpagg::operation::sum>(
        warpagg::reduce::butterfly{}, serial, [](int) { return 3.0f; }, results);
    return results[0] == 3;
}

}  // namespace

int main() {
    const bool works = counts() && adds_components() && adds_cells() && adds_in_order() && reduces();
    std::puts(works ? "the old names work" : "an old name does something else");
    return works ? 0 : 1;
}
