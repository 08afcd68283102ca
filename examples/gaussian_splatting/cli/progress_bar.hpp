// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../training/training.hpp"

namespace gs::cli {

/// A line that is written over on a terminal, and a plain line now and then where there is none.
class progress_bar {
  public:
    explicit progress_bar(bool quiet);
    progress_bar(const progress_bar&) = delete;
    progress_bar& operator=(const progress_bar&) = delete;
    /// What comes next has a line of its own, also after an error.
    ~progress_bar();
    void show(const train::progress& p);
    /// Makes room for a line of another's.
    void clear();

  private:
    bool quiet_, terminal_;
    bool open_ = false;  ///< the cursor is in the bar's line
    int lines_ = 0;
};

}  // namespace gs::cli
