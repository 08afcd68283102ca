// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../train/trainer.hpp"

namespace gs::cli {

/// A line that is written over on a terminal, and a plain line now and then where there is none.
class progress_bar {
  public:
    explicit progress_bar(bool quiet);
    void show(const train::progress& p);
    /// Makes room for a line of another's.
    void clear() const;

  private:
    bool quiet_, terminal_;
    int lines_ = 0;
};

}  // namespace gs::cli
