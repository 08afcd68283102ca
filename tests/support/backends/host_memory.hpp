// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

/// The memory that an emulated warp sees: the host's.
template <class T>
class host_memory {
  public:
    explicit host_memory(std::vector<T> content) : content_(std::move(content)) {}
    T* data() { return content_.data(); }
    std::vector<T> download() const { return content_; }

  private:
    std::vector<T> content_;
};
