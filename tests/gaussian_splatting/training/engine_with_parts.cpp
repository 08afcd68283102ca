// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "engine_with_parts.hpp"

#include "training/device_engine.hpp"

#if !defined(WARPAGG_CPU_LEVELS)
// The library contains it. If it is compiled for several instruction sets, this file must compile one more.
extern template class gs::train::device_engine<gs::device::cpu>;
#endif

std::unique_ptr<gs::train::engine> make_engine_with(gs::train::engine_parts<gs::device::cpu> parts) {
    return std::make_unique<gs::train::device_engine<gs::device::cpu>>(parts);
}
