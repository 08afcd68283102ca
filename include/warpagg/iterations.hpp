// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "core/call_site.hpp"

namespace warpagg {

/// The numbers from 0 to n - 1, for a loop that contains collectives: `for (unsigned i :
/// iterations(w, n))`. `emulator::checked` diagnoses lanes that meet in different iterations of the
/// loop, for example after a `continue` that only some lanes take. On other models it is an ordinary
/// loop, at no cost. `n` may differ between lanes.
template <class W>
class iterations {
  public:
    /// Counts from 0 to `n` - 1. Leave `at` at its default, the call site.
    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD iterations(const W& w, unsigned n, call_site at = call_site::here("iterations"))
        : w_(w), n_(n) {
        if constexpr (requires { w.enter_loop(at); }) w.enter_loop(at);
    }
    iterations(const iterations&) = delete;
    iterations& operator=(const iterations&) = delete;
    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD ~iterations() {
        if constexpr (requires { w_.leave_loop(); }) w_.leave_loop();
    }

    /// The iterator of a range-based `for`.
    class iterator {
      public:
        /// @{
        /// Works as in any iterator over unsigned numbers.
        WARPAGG_HD iterator(const W& w, unsigned i) : w_(w), i_(i) {}
        WARPAGG_HD unsigned operator*() const { return i_; }
        WARPAGG_EXEC_CHECK_DISABLE
        WARPAGG_HD iterator& operator++() {
            if constexpr (requires { w_.next_iteration(); }) w_.next_iteration();
            ++i_;
            return *this;
        }
        WARPAGG_HD bool operator!=(const iterator& b) const { return i_ != b.i_; }
        /// @}

      private:
        const W& w_;
        unsigned i_;
    };
    /// @{
    /// Returns an iterator for a range-based `for`.
    WARPAGG_HD iterator begin() const { return {w_, 0}; }
    WARPAGG_HD iterator end() const { return {w_, n_}; }
    /// @}

  private:
    const W& w_;
    unsigned n_;
};

}  // namespace warpagg
