// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "compiler.hpp"

namespace warpagg {

/// The name of a called function and the file and line of the call. The diagnoses of
/// `emulator::checked` report it. Other models ignore it, at no cost.
struct call_site {
    const char* function;  ///< name of the called function
    const char* file;      ///< file of the call
    unsigned line;         ///< line of the call

    /// Returns the call site of the function that has this call in a default argument.
    static constexpr WARPAGG_HD call_site here(const char* function, const char* file = __builtin_FILE(),
                                               unsigned line = __builtin_LINE()) {
        return {function, file, line};
    }
};

namespace detail {

/// Marks a library call for models that have `enter` and `leave`. During its lifetime, such a model
/// attributes the warp's operations to the call at `at`.
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
