// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/warp/concept.hpp>

#include "../device/atomic.hpp"
#include "fault_report.hpp"

namespace gs::train {

/// Records faults of kernels in device memory, so that the host need not wait for each step. Counts
/// the faults of each kind. Keeps the earliest one as an integer: iteration, parameter and Gaussian
/// in 24, 8 and 32 bits, from the highest bit down.
struct finite_check {
    struct memory {
        unsigned long long first[fault_kind_count];  ///< initially `none`
        unsigned long long count[fault_kind_count];
    };
    static constexpr unsigned long long none = ~0ull;

    memory* found;
    std::uint32_t iteration;

    WARPAGG_HD void note(fault_kind kind, std::uint32_t parameter, std::uint32_t gaussian) const {
        const auto high = static_cast<unsigned long long>(iteration) << 8 | parameter;
        device::atomic_min(&found->first[static_cast<int>(kind)], high << 32 | gaussian);
        device::atomic_add(&found->count[static_cast<int>(kind)], 1);
    }

    /// Records `times[lane]` faults for each lane. Lane i holds Gaussian `gaussian + i`.
    template <class W>
    WARPAGG_HD void note(const W& w, fault_kind kind, parameter p, std::size_t gaussian,
                         const warpagg::value_t<W, unsigned>& times) const {
        using number = unsigned long long;
        const auto high = static_cast<number>(iteration) << 8 | static_cast<number>(p);
        const auto k = static_cast<int>(kind);
        const warpagg::mask_t<W> active = times != warpagg::value_t<W, unsigned>(0);
        w.atomic(
            warpagg::operation::minimum{}, [this, k](unsigned) { return &found->first[k]; }, 0u,
            warpagg::math::convert<number>(w.lane()) + (high << 32 | gaussian), active);
        w.atomic(
            warpagg::operation::sum{}, [this, k](unsigned) { return &found->count[k]; }, 0u,
            warpagg::math::convert<number>(times), active);
    }

    /// Returns the initial memory, without faults.
    static memory clean() {
        memory m{};
        for (auto& f : m.first) f = none;
        return m;
    }
    static fault_reports decode(const memory& m) {
        fault_reports all;
        for (std::size_t k = 0; k < fault_kind_count; ++k) {
            all[k].count = m.count[k];
            all[k].iteration = static_cast<int>(m.first[k] >> 40);
            all[k].parameter = static_cast<gs::parameter>(m.first[k] >> 32 & 0xff);
            all[k].gaussian = static_cast<std::uint32_t>(m.first[k]);
        }
        return all;
    }
};

}  // namespace gs::train
