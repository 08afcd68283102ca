// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "../../core/call_site.hpp"

namespace warpagg::emulator::detail {

/// Finds out whether memory depends on undefined values: a second process goes on with other values in their
/// place and the same schedule, and both keep a list of what the lanes write. Differences depend on the
/// undefined values, in whatever way: by sums, comparisons or branches.
class shadow_process {
  public:
    struct write {
        call_site at;
        unsigned block, thread;
        std::size_t reads_before;  ///< how many undefined values had been read
    };

    virtual ~shadow_process() = default;

    /// Whether this is the second process.
    virtual bool is_child() const = 0;
    /// Called before each write, and before the operand of an atomic is combined.
    virtual void note(const write& who, const void* address, const void* value, std::size_t size) = 0;
    /// In the child, after the launch: sends its list and ends the process.
    [[noreturn]] virtual void hand_over() = 0;
    /// In the parent, after the launch: whether the child made other writes, or did not end within a minute.
    virtual bool differs() = 0;
    /// After `differs`: the first write that the child did not make in the same way; null if the child made
    /// all of them and more.
    virtual const write* first_difference() const = 0;
};

/// Starts a shadow process. Null unless the program includes fork_shadow_process.hpp, so that this emulator
/// never forks by itself.
inline std::unique_ptr<shadow_process> (*start_shadow_process)() = nullptr;

}  // namespace warpagg::emulator::detail
