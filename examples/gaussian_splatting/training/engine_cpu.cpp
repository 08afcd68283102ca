// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../device/cpu/cpu.hpp"
#include "device_engine.hpp"

#if !defined(WARPAGG_MAKE_CPU_ENGINE)
#define WARPAGG_MAKE_CPU_ENGINE make_cpu_engine_as_built
#endif

// All members, which tests call for engines with parts of their own.
template class gs::train::device_engine<gs::device::cpu>;

/// Creates the CPU engine for the instruction set that this file is compiled for. See
/// cpu_engines.cpp.
extern "C" gs::train::engine* WARPAGG_MAKE_CPU_ENGINE() {
    return new gs::train::device_engine<gs::device::cpu>;
}
