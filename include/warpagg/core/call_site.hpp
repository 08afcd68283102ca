// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "compiler.hpp"

namespace warpagg {

/// Which function of the library was called, and where, for the emulator's diagnoses. On other models nobody
/// reads it and it costs nothing.
struct call_site {
    const char* function;  ///< of the library
    const char* file;      ///< where it was called
    unsigned line;         ///< where it was called

    /// The place of the call in whose default argument this stands.
    static constexpr WARPAGG_HD call_site here(const char* function, const char* file = __builtin_FILE(),
                                               unsigned line = __builtin_LINE()) {
        return {function, file, line};
    }
};

namespace detail {

/// As long as it lives, the model knows, if it wants to, on whose behalf the library works.
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
