// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "../../core/call_site.hpp"

namespace warpagg::emulator::detail {

/// Finds out whether memory depends on undefined values. A second process continues with the same schedule
/// and other undefined values. Both record all writes of the lanes. Any difference comes from an undefined
/// value, through sums, comparisons or branches.
class shadow_process {
  public:
    struct write {
        call_site at;
        unsigned block, thread;
        std::size_t reads_before;  ///< number of undefined values read before the write
    };

    virtual ~shadow_process() = default;

    /// Returns whether this is the second process.
    virtual bool is_child() const = 0;
    /// Records a write of `size` bytes, or the operand of an atomic. Call it before the access.
    virtual void note(const write& who, const void* address, const void* value, std::size_t size) = 0;
    /// Sends the child's list to the parent and ends the child. Call it in the child after the launch.
    [[noreturn]] virtual void hand_over() = 0;
    /// Returns whether the child made other writes, or did not send its list in time: a minute without
    /// data ends the wait. Call it in the parent after the launch.
    virtual bool differs() = 0;
    /// Returns the first write of the parent that the child did not make in the same way, or null if the
    /// child made all of them and more. Call it after `differs`.
    virtual const write* first_difference() const = 0;
};

/// Starts a shadow process. The pointer is null unless the program includes fork_shadow_process.hpp, so the
/// emulator never forks by default.
inline std::unique_ptr<shadow_process> (*start_shadow_process)() = nullptr;

}  // namespace warpagg::emulator::detail
