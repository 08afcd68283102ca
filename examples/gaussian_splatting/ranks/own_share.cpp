// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "own_share.hpp"

#include <algorithm>
#include <vector>

namespace gs::ranks {

namespace {

/// Returns a value of each rank.
std::vector<std::uint64_t> values_of_all(communicator& all, std::uint64_t own) {
    const traffic_counter::scope scope(all.traffic(), purpose::connection);
    std::vector<std::uint64_t> values(static_cast<std::size_t>(all.count()));
    values[static_cast<std::size_t>(all.rank())] = own;
    all.sum(values.data(), values.size());
    return values;
}

}  // namespace

int own_threads(communicator& all, int threads, std::uint64_t processors) {
    const auto numbers = values_of_all(all, processors);
    const auto sharing = static_cast<int>(std::count(numbers.begin(), numbers.end(), processors));
    const auto before = std::count(numbers.begin(), numbers.begin() + all.rank(), processors);
    const int more = before < threads % sharing ? 1 : 0;
    return std::max(1, threads / sharing + more);
}

int first_without_device(communicator& all, std::uint64_t device) {
    const auto devices = values_of_all(all, device);
    auto one = devices.begin();
    while (one != devices.end() && *one != 0 && std::find(devices.begin(), one, *one) == one) ++one;
    return static_cast<int>(one - devices.begin());
}

}  // namespace gs::ranks
