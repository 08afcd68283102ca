// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <tuple>
#include <utility>

#include "runtime_interface.hpp"

namespace warpagg::emulator {

/// The parameters of a launch of a CUDA kernel.
struct cuda_grid {
    dim3 blocks{};                        ///< number of blocks
    dim3 threads{32};                     ///< threads per block, at most 1024
    std::size_t shared_bytes = 0;         ///< dynamic shared memory in bytes, at most 48 KiB
    std::optional<std::uint64_t> seed{};  ///< seed of the schedule; default: $WARPAGG_SEED, or 1
};

/// Works as `kernel<<<g.blocks, g.threads, g.shared_bytes>>>(args...)` and returns the report. Blocks run
/// one after another, in an order drawn from the seed. A diagnosis ends the launch: threads do not
/// continue, and destructors of their objects do not run. Pass a `device_array` for each pointer.
///
/// Errors: aborts the program if a size is not allowed. Cost: a call of the emulator per memory access and
/// per warp operation of a thread, which is fast enough for tests only; and a run of addr2line for each line
/// that a report names for the first time.
template <class... P, class... A>
requires(sizeof...(P) == sizeof...(A)) report
    try_launch(void (*kernel)(P...), const cuda_grid& g, A&&... args) {
    const auto call = [kernel, arguments = std::tuple<P...>(std::forward<A>(args)...)] {
        const auto own_kernel = kernel;  // on the thread's stack, which is private to it
        std::tuple<P...> own_arguments = arguments;
        detail::runtime::enter_kernel();
        std::apply(own_kernel, own_arguments);
        detail::runtime::leave_kernel();
    };
    return detail::runtime::run(
        g, [](const void* f) { (*static_cast<decltype(&call)>(f))(); }, &call);
}

/// Works as `try_launch`, but prints a diagnosis on stderr and aborts the program.
/// @{
template <class... P, class... A>
requires(sizeof...(P) == sizeof...(A)) void launch(void (*kernel)(P...), const cuda_grid& g, A&&... args) {
    const report r = try_launch(kernel, g, std::forward<A>(args)...);
    if (r.ok()) return;
    std::fputs(r.text().c_str(), stderr);
    std::abort();
}
template <class... P, class... A>
requires(sizeof...(P) == sizeof...(A)) void launch(void (*kernel)(P...), dim3 blocks, dim3 threads,
                                                   A&&... args) {
    launch(kernel, cuda_grid{blocks, threads}, std::forward<A>(args)...);
}
/// @}

}  // namespace warpagg::emulator
