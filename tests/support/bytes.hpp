// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gs_test {

/// A binary file in the making, as COLMAP writes it: values as they lie in memory, texts with their final
/// zero.
class bytes {
  public:
    template <class T>
    bytes& put(const T& value) {
        data_.append(reinterpret_cast<const char*>(&value), sizeof(T));
        return *this;
    }
    bytes& put_text(const std::string& text) {
        data_.append(text.c_str(), text.size() + 1);
        return *this;
    }
    const std::string& data() const { return data_; }

  private:
    std::string data_;
};

}  // namespace gs_test
