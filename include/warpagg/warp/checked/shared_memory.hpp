// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "../../core/call_site.hpp"
#include "diagnosis.hpp"

namespace warpagg::emulator::detail {

/// The shared arrays of a block. The call site that declares an array identifies it, as a `__shared__`
/// declaration does.
class shared_memory {
  public:
    /// Prepares for the next block, which uses the same memory. Calls `forget(first, size)` for each
    /// array and overwrites it.
    template <class F>
    void begin_block(F forget) {
        for (array& a : arrays_) {
            forget(a.first.get(), a.size);  // mutate: blocks_inherit_shared_accesses
            spoil(a);                       // mutate: blocks_inherit_shared_values
        }
    }

    /// Returns the memory of the array of `size` bytes that `at` declares, the same for all threads of
    /// the block.
    void* at(const call_site& at, std::size_t size) {
        for (array& a : arrays_)
            if (same(a.at, at) && a.size == size) return a.first.get();
        arrays_.push_back({at, size, std::make_unique<std::byte[]>(size)});
        spoil(arrays_.back());
        return arrays_.back().first.get();
    }

  private:
    struct array {
        call_site at;
        std::size_t size;
        std::unique_ptr<std::byte[]> first;
    };
    /// Sets all bits of the array, so that floats are NaN.
    // mutate: shared_memory_starts_at_zero
    static void spoil(array& a) { std::memset(a.first.get(), 0xff, a.size); }

    std::vector<array> arrays_;
};

}  // namespace warpagg::emulator::detail
