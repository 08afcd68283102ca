// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The emulator of emulate_cuda.hpp. Include this header in exactly one source file of a test program, and
/// compile that file without -fsanitize=thread. The CMake function `warpagg_emulate_cuda` does both. It
/// includes fork_shadow_process.hpp, so other source files must not.

#if defined(__SANITIZE_THREAD__)
#error "compile warpagg/emulate_cuda/runtime.hpp without -fsanitize=thread"
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#error "compile warpagg/emulate_cuda/runtime.hpp without -fsanitize=thread"
#endif
#endif

#include "../warp/fork_shadow_process.hpp"
#include "runtime/hooks.hpp"
#include "runtime/thread_state.hpp"

constinit thread_local uint3 threadIdx{}, blockIdx{};
constinit thread_local dim3 blockDim, gridDim;

namespace warpagg::emulator::detail {

/// The collectives of `checked` for any lanes.
struct cuda_collectives {
    using lanes = runtime::lanes;
    static checked w() { return checked(*simulator::running()); }
    static checked::who who(lanes l) { return {l.mask, l.all}; }

    static std::uint32_t vote(lanes l, bool p, const call_site& at) { return w().vote(who(l), p, at); }
    static std::uint32_t match(lanes l, std::uint64_t key, const call_site& at) {
        return w().equal(who(l), key, at);
    }
    template <class T>
    static T exchange(lanes l, T v, unsigned from, const call_site& at) {
        return w().exchange(who(l), v, from, at);
    }
    static void sync(lanes l, const call_site& at) { w().synchronize(who(l), at); }
};

namespace runtime {

unsigned lane() { return simulator::running()->lane(); }

void barrier(const call_site& at) {
    const in_emulator guard;
    simulator::running()->barrier(at);
}
unsigned count_at_barrier(bool p, const call_site& at) {
    const in_emulator guard;
    thread_state& state = thread_state::instance();
    const unsigned phase = state.m().phase();
    state.count(phase, p);
    state.m().barrier(at);
    return state.counted(phase);
}
void sync(lanes who, const call_site& at) {
    const in_emulator guard;
    cuda_collectives::sync(who, at);
}
std::uint32_t vote(lanes who, bool p, const call_site& at) {
    const in_emulator guard;
    return cuda_collectives::vote(who, p, at);
}
std::uint32_t match(lanes who, std::uint64_t key, const call_site& at) {
    const in_emulator guard;
    return cuda_collectives::match(who, key, at);
}
std::uint32_t activemask(const call_site& at) {
    const in_emulator guard;
    return cuda_collectives::w().activemask(at);
}
template <class T>
T exchange_word(lanes who, T v, unsigned from, const call_site& at) {
    const in_emulator guard;
    return cuda_collectives::exchange(who, v, from, at);
}
template float exchange_word(lanes, float, unsigned, const call_site&);
template double exchange_word(lanes, double, unsigned, const call_site&);
template std::uint8_t exchange_word(lanes, std::uint8_t, unsigned, const call_site&);
template std::uint16_t exchange_word(lanes, std::uint16_t, unsigned, const call_site&);
template std::uint32_t exchange_word(lanes, std::uint32_t, unsigned, const call_site&);
template std::uint64_t exchange_word(lanes, std::uint64_t, unsigned, const call_site&);

void begin_read(const void* address, std::size_t size, const call_site& at) {
    thread_state::instance().suspend();
    thread_state::instance().access(address, size, access_kind::read, at);
}
void begin_write(const void* address, std::size_t size, const call_site& at) {
    thread_state::instance().suspend();
    thread_state::instance().access(address, size, access_kind::write, at);
    thread_state::instance().expect_write(address, size, at);
}
template <class T>
void begin_atomic(T* address, T v, const call_site& at) {
    thread_state& state = thread_state::instance();
    state.suspend();
    state.access(address, sizeof(T), access_kind::atomic, at);
    state.m().find_undefined(address, v, at);
}
template void begin_atomic(float*, float, const call_site&);
template void begin_atomic(double*, double, const call_site&);
template void begin_atomic(std::uint32_t*, std::uint32_t, const call_site&);
template void begin_atomic(std::uint64_t*, std::uint64_t, const call_site&);
void end_access() { thread_state::instance().resume(); }

void require_uniform(const void* destination, const call_site& at) {
    const in_emulator guard;
    cuda_collectives::w().require_uniform(destination, at);
}
void require_busy(bool busy, const call_site& at) {
    const in_emulator guard;
    cuda_collectives::w().require_busy(busy, at);
}
void enter(const call_site& at) {
    const in_emulator guard;
    cuda_collectives::w().enter(at);
}
void leave() {
    const in_emulator guard;
    cuda_collectives::w().leave();
}
void enter_loop(const call_site& at) {
    const in_emulator guard;
    cuda_collectives::w().enter_loop(at);
}
void next_iteration() {
    const in_emulator guard;
    cuda_collectives::w().next_iteration();
}
void leave_loop() {
    const in_emulator guard;
    cuda_collectives::w().leave_loop();
}

void enter_kernel() { thread_state::instance().begin_thread(); }
void leave_kernel() { thread_state::instance().suspend(); }

report run(const cuda_grid& g, void (*thread)(const void* kernel), const void* kernel) {
    const std::uint64_t blocks = std::uint64_t{g.blocks.x} * g.blocks.y * g.blocks.z;
    const std::uint64_t threads = std::uint64_t{g.threads.x} * g.threads.y * g.threads.z;
    if (blocks == 0 || blocks > 0xffffffffu || threads == 0 || threads > 1024 || g.shared_bytes > 48 * 1024) {
        std::fprintf(
            stderr,
            "warpagg: a launch of %llu blocks of %llu threads with %zu bytes of dynamic shared memory; "
            "a block takes 1 to 1024 threads and at most 49152 bytes\n",
            static_cast<unsigned long long>(blocks), static_cast<unsigned long long>(threads),
            g.shared_bytes);
        std::abort();
    }
    const std::uint64_t seed = g.seed.value_or(seed_in_environment().value_or(1));
    thread_state::instance().begin_launch(g);
    simulator m(static_cast<unsigned>(blocks), static_cast<unsigned>(threads), checked::size, seed, nullptr);
    report r = m.run([&](simulator&) { thread(kernel); });
    r.at = locate(r.at);
    r.other = locate(r.other);
    return r;
}

void* allocate(std::size_t bytes) { return heap_arrays::instance().allocate(bytes); }
void deallocate(void* memory) { heap_arrays::instance().deallocate(memory); }
void define(const void* memory, std::size_t bytes) {
    const auto first = reinterpret_cast<location>(memory);
    const tracked_bytes array = heap_arrays::instance().find(first);
    if (first >= array.first && first + bytes <= array.first + array.size) array.touch(first, bytes, true);
}
void add_dynamic_shared(void* (*address)(), std::size_t capacity) {
    dynamic_arrays().push_back({address, capacity});
}

}  // namespace runtime
}  // namespace warpagg::emulator::detail
