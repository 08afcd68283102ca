// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>
#include <warpagg/atomic.hpp>
#include <warpagg/warp/simd.hpp>

namespace example {

/// The CPU: warps run one after the other on the emulator, which counts what they do. The interface is that
/// of the machine in cuda.hpp.
struct machine {
    static constexpr const char* name = "the emulator";
    static constexpr unsigned default_size = 1u << 18;
    static constexpr const char* cost_columns = "shuffles | sectors";
    static constexpr const char* rule = "| --- | --- | --- | --- | --- | --- |";

    template <class T>
    class array {
      public:
        explicit array(std::size_t size) : content_(size) {}
        explicit array(std::vector<T> content) : content_(std::move(content)) {}
        T* data() { return content_.data(); }
        void zero() { content_.assign(content_.size(), T{}); }
        std::vector<T> download() const { return content_; }

      private:
        std::vector<T> content_;
    };

    using measured = warpagg::emulator::counters;

    /// Runs `kernel(w, first)` for all its lanes and counts.
    template <class Kernel>
    static measured run(const Kernel& kernel) {
        warpagg::emulator::counters did;
        const warpagg::emulator::counted_lanes w{{&did}};
        for (unsigned first = 0; first < kernel.lanes(); first += w.size) kernel(w, first);
        return did;
    }

    /// An emulator's time says nothing about a GPU's, so there is nothing to add to what was counted.
    template <class T, class A, class B>
    static void time(array<T>&, const A&, measured&, const B&, measured&) {}

    static void print_cost(const measured&, const measured& m) {
        std::printf("%8llu | %8llu |\n", static_cast<unsigned long long>(m.shuffles),
                    static_cast<unsigned long long>(m.sectors));
    }
};

}  // namespace example
