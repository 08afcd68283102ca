// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../training/training.hpp"

namespace gs::cli {

/// Shows the progress of training. On a terminal, it overwrites one line; elsewhere it prints up to
/// twenty lines.
class progress_bar {
  public:
    explicit progress_bar(bool quiet);
    progress_bar(const progress_bar&) = delete;
    progress_bar& operator=(const progress_bar&) = delete;
    /// Ends the line of the bar, so that an error message begins on a new line.
    ~progress_bar();
    void show(const train::progress& p);
    /// Clears the line of the bar for other output.
    void clear();

  private:
    bool quiet_, terminal_;
    bool open_ = false;  ///< whether the cursor is in the line of the bar
    int lines_ = 0;
};

}  // namespace gs::cli
