// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../training/training.hpp"

namespace gs::cli {

/// Shows where training stands: on a terminal in one line that is overwritten, elsewhere in up to twenty
/// lines.
class progress_bar {
  public:
    explicit progress_bar(bool quiet);
    progress_bar(const progress_bar&) = delete;
    progress_bar& operator=(const progress_bar&) = delete;
    /// Ends the bar's line, so that an error message begins in a new one.
    ~progress_bar();
    void show(const train::progress& p);
    /// Clears the bar's line for other output.
    void clear();

  private:
    bool quiet_, terminal_;
    bool open_ = false;  ///< the cursor is in the line of the bar
    int lines_ = 0;
};

}  // namespace gs::cli
