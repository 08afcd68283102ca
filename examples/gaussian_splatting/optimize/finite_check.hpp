// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <warpagg/warp/concept.hpp>

#include "../device/atomic.hpp"
#include "fault_report.hpp"

namespace gs::train {

/// Where kernels note what is not finite, on the device, so that nobody waits for it: of each kind the
/// earliest and how many there were. The earliest is a number: iteration, parameter and Gaussian from its
/// highest bits down, 24, 8 and 32 of them.
struct watch {
    struct memory {
        unsigned long long first[fault_count];  ///< `nothing` at the start
        unsigned long long count[fault_count];
    };
    static constexpr unsigned long long nothing = ~0ull;

    memory* found;
    std::uint32_t iteration;

    WARPAGG_HD void note(fault kind, std::uint32_t parameter, std::uint32_t gaussian) const {
        const auto high = static_cast<unsigned long long>(iteration) << 8 | parameter;
        device::atomic_min(&found->first[static_cast<int>(kind)], high << 32 | gaussian);
        device::atomic_add(&found->count[static_cast<int>(kind)], 1);
    }

    /// As many times as each lane says; the first lane's Gaussian is `gaussian`.
    template <class W>
    WARPAGG_HD void note(const W& w, fault kind, parameter p, std::size_t gaussian,
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

    static memory clean() {
        memory m{};
        for (auto& f : m.first) f = nothing;
        return m;
    }
    static findings decode(const memory& m) {
        findings all;
        for (std::size_t k = 0; k < fault_count; ++k) {
            all[k].count = m.count[k];
            all[k].iteration = static_cast<int>(m.first[k] >> 40);
            all[k].parameter = static_cast<gs::parameter>(m.first[k] >> 32 & 0xff);
            all[k].gaussian = static_cast<std::uint32_t>(m.first[k]);
        }
        return all;
    }
};

}  // namespace gs::train
