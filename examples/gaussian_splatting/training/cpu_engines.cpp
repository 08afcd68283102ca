// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../core/error.hpp"
#include "../engine/engine.hpp"

extern "C" {
// Each function is compiled from engine_cpu.cpp, for another instruction set.
#if defined(WARPAGG_CPU_LEVELS)
gs::train::engine* make_cpu_engine_x86_64_v3();
gs::train::engine* make_cpu_engine_x86_64_v4();
#else
gs::train::engine* make_cpu_engine_as_built();
#endif
}

namespace gs::train {

namespace {

template <engine* (*Make)()>
std::unique_ptr<engine> make() {
    return std::unique_ptr<engine>(Make());
}

}  // namespace

std::vector<std::unique_ptr<engine> (*)()> cpu_engines() {
#if defined(WARPAGG_CPU_LEVELS)
    std::vector<std::unique_ptr<engine> (*)()> all;
    if (__builtin_cpu_supports("x86-64-v3")) all.push_back(make<make_cpu_engine_x86_64_v3>);
    if (__builtin_cpu_supports("x86-64-v4")) all.push_back(make<make_cpu_engine_x86_64_v4>);
    return all;
#else
    return {make<make_cpu_engine_as_built>};
#endif
}

std::unique_ptr<engine> make_cpu_engine() {
    const auto all = cpu_engines();
    if (all.empty())
        throw error(
            "the kernels for the CPU are compiled for AVX2 and AVX-512, and this one has neither: build with "
            "-DWARPAGG_CPU_LEVELS=OFF -DWARPAGG_CPU_ARCH=native");
    return all.back()();
}

}  // namespace gs::train
