// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The memory that a kernel may access, and which bytes of it have been written: arrays on the heap, shared
/// memory, and the variables of the program.

#include <link.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <vector>

namespace warpagg::emulator::detail::runtime {

using location = std::uintptr_t;

/// What is known of a byte. A byte that was never touched is 0 in shared memory.
enum byte_flags : std::uint8_t { defined = 1, touched = 2, filled = 4 };  // filled: with 0xff, before use

/// Bytes from `first` on, with flags for each of them.
struct tracked_bytes {
    location first = 0;
    std::size_t size = 0;
    std::uint8_t* flags = nullptr;  ///< null if all bytes have values

    bool has(location a) const { return a - first < size; }

    /// Marks bytes as used, and as defined if `is_write`.
    void touch(location a, std::size_t n, bool is_write) const {
        for (std::size_t i = a - first; i < a - first + n; ++i)
            flags[i] = static_cast<std::uint8_t>(flags[i] | touched | (is_write ? defined : 0));
    }
    /// Returns whether something has written these bytes: all bytes of a word, or some of a range, which may
    /// be a struct with padding. Changed bytes count as well, because GCC does not report all writes of
    /// structs.
    bool has_value(location a, std::size_t n, bool is_range) const {
        std::size_t known = 0;
        for (std::size_t i = a - first; i < a - first + n; ++i) {
            const std::uint8_t before = (flags[i] & filled) != 0 ? 0xff : 0;
            if ((flags[i] & defined) != 0) ++known;
            // mutate: unreported_writes_ignored
            else if (*reinterpret_cast<const std::uint8_t*>(first + i) != before)
                return true;
        }
        return known == n || (is_range && known > 0);
    }
};

/// The arrays that kernels may access; all threads of the program share it. Gaps around each array keep
/// accesses out of bounds from reaching another one.
class heap_arrays {
  public:
    static heap_arrays& instance() {
        static heap_arrays all;
        return all;
    }

    void* allocate(std::size_t size) {
        const std::size_t gap = gap_of(size);
        auto* const memory = static_cast<std::byte*>(::operator new(size + 2 * gap, alignment));
        std::memset(memory, 0xff, size + 2 * gap);
        auto flags = std::make_unique<std::uint8_t[]>(size);
        std::memset(flags.get(), filled, size);
        const std::lock_guard lock(mutex_);
        const auto first = reinterpret_cast<location>(memory + gap);
        arrays_[first] = {{first, size, flags.get()}, std::move(flags)};
        return memory + gap;
    }
    void deallocate(void* memory) {
        const std::lock_guard lock(mutex_);
        const auto found = arrays_.find(reinterpret_cast<location>(memory));
        const std::size_t gap = gap_of(found->second.bytes.size);
        arrays_.erase(found);
        ::operator delete(static_cast<std::byte*>(memory) - gap, alignment);
    }

    /// Returns the array that contains the address or has it in one of its gaps. The size is 0 if there is
    /// none.
    tracked_bytes find(location a) {
        const std::lock_guard lock(mutex_);
        const auto after = arrays_.upper_bound(a);
        if (after != arrays_.begin()) {
            const tracked_bytes& b = std::prev(after)->second.bytes;
            if (a - b.first < b.size + gap_of(b.size)) return b;
        }
        if (after != arrays_.end()) {
            const tracked_bytes& b = after->second.bytes;
            if (b.first - a <= gap_of(b.size)) return b;
        }
        return {};
    }

  private:
    static constexpr std::align_val_t alignment{256};
    static std::size_t gap_of(std::size_t size) {
        return std::max<std::size_t>(4096, (size + 255) / 256 * 256);
    }

    struct array {
        tracked_bytes bytes;
        std::unique_ptr<std::uint8_t[]> flags;
    };
    std::mutex mutex_;
    std::map<location, array> arrays_;
};

/// The shared memory of a thread's launches: its thread-local variables. Only kernels and this class may
/// use it.
class shared_variables {
  public:
    shared_variables() {
        dl_iterate_phdr(
            [](dl_phdr_info* module, std::size_t, void* self) {
                for (int i = 0; i < module->dlpi_phnum; ++i) {
                    const ElfW(Phdr)& part = module->dlpi_phdr[i];
                    if (part.p_type == PT_TLS && module->dlpi_tls_data != nullptr)
                        static_cast<shared_variables*>(self)->add(module->dlpi_tls_data, part.p_memsz);
                }
                return 0;
            },
            this);
    }

    /// Forgets all values, for the next block. Calls `forget(first, size)` for the bytes that were used.
    template <class F>
    void begin_block(F forget) {
        for (block& b : blocks_) {
            if (b.used_from >= b.used_to) continue;
            forget(reinterpret_cast<void*>(b.bytes.first + b.used_from), b.used_to - b.used_from);
            for (std::size_t i = b.used_from; i < b.used_to; ++i) {
                if (b.flags[i] == 0) continue;  // perhaps not a shared variable
                *reinterpret_cast<std::uint8_t*>(b.bytes.first + i) = 0xff;
                b.flags[i] = filled;  // mutate: cuda_blocks_inherit_shared_values
            }
            b.used_from = b.bytes.size;
            b.used_to = 0;
        }
    }
    /// Returns the variables that contain the address, or bytes of size 0.
    tracked_bytes use(location a, std::size_t size) {
        for (block& b : blocks_) {
            if (!b.bytes.has(a)) continue;
            const std::size_t from = a - b.bytes.first;
            b.used_from = std::min(b.used_from, from);
            b.used_to = std::max(b.used_to, std::min(from + size, b.bytes.size));
            return b.bytes;
        }
        return {};
    }

  private:
    struct block {
        tracked_bytes bytes;
        std::unique_ptr<std::uint8_t[]> flags;
        std::size_t used_from, used_to;
    };
    void add(void* first, std::size_t size) {
        auto flags = std::make_unique<std::uint8_t[]>(size);
        blocks_.push_back(
            {{reinterpret_cast<location>(first), size, flags.get()}, std::move(flags), size, 0});
    }
    std::vector<block> blocks_;
};

/// Returns whether these bytes are variables or constants of the program or of its libraries.
inline bool in_program(location first, std::size_t size) {
    struct range {
        location first, end;
    };
    static const std::vector<range> ranges = [] {
        std::vector<range> all;
        dl_iterate_phdr(
            [](dl_phdr_info* module, std::size_t, void* to) {
                for (int i = 0; i < module->dlpi_phnum; ++i) {
                    const ElfW(Phdr)& part = module->dlpi_phdr[i];
                    const location from = module->dlpi_addr + part.p_vaddr;
                    if (part.p_type == PT_LOAD)
                        static_cast<std::vector<range>*>(to)->push_back({from, from + part.p_memsz});
                }
                return 0;
            },
            &all);
        return all;
    }();
    return std::any_of(ranges.begin(), ranges.end(),
                       [&](const range& r) { return first >= r.first && first + size <= r.end; });
}

/// The arrays `extern __shared__` of the program.
struct dynamic_shared {
    void* (*address)();
    std::size_t capacity;
};
inline std::vector<dynamic_shared>& dynamic_arrays() {
    static std::vector<dynamic_shared> all;
    return all;
}

}  // namespace warpagg::emulator::detail::runtime
