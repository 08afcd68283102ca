// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "compiler.hpp"

namespace warpagg {

/// The called function of the library and the line of the call, for the diagnoses of
/// `emulator::checked`. Other models do not read it, and it costs nothing there.
struct call_site {
    const char* function;  ///< the called function
    const char* file;      ///< of the call
    unsigned line;         ///< of the call

    /// In a default argument: the place of the call.
    static constexpr WARPAGG_HD call_site here(const char* function, const char* file = __builtin_FILE(),
                                               unsigned line = __builtin_LINE()) {
        return {function, file, line};
    }
};

namespace detail {

/// While it lives, a model that has `enter` and `leave` attributes operations to the library call
/// at `at`.
template <class W>
class library_call {
  public:
    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD library_call(const W& w, const call_site& at) : w_(w) {
        if constexpr (requires { w.enter(at); }) w.enter(at);
    }
    library_call(const library_call&) = delete;
    library_call& operator=(const library_call&) = delete;
    WARPAGG_EXEC_CHECK_DISABLE
    WARPAGG_HD ~library_call() {
        if constexpr (requires { w_.leave(); }) w_.leave();
    }

  private:
    const W& w_;
};

}  // namespace detail
}  // namespace warpagg
