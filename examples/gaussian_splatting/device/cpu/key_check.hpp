// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "../../core/error.hpp"
#include "../stages.hpp"

namespace gs::device {

/// Checks graph keys on the CPU: iterations with equal keys must launch the same kernels over the
/// same ranges, and only the first of them may allocate memory. A GPU captures all but the first as
/// graphs, and cannot allocate during a capture. A violation is an error. Cost: a few comparisons
/// per launch.
class key_check {
  public:
    /// Returns an address that is unique to a type of kernel.
    template <class Kernel>
    static const void* id() {
        static constexpr char address = 0;
        return &address;
    }

    template <class F>
    void iteration(const graph_key& key, const F& f) {
        const auto [entry, is_new] = launches_.try_emplace(key);
        expected_ = &entry->second;
        is_new_ = is_new;
        next_ = 0;
        current_ = this;
        try {
            f();
        } catch (...) {
            current_ = nullptr;
            if (is_new) launches_.erase(entry);
            throw;
        }
        current_ = nullptr;
        if (next_ != expected_->size()) fail("made fewer launches");
    }

    /// Checks a launch over `n` elements if an iteration is running.
    template <class Kernel>
    static void launched(std::size_t n) {
        if (current_ != nullptr) current_->compare({id<Kernel>(), n});
    }

    /// Checks that an allocation is allowed. Call it when memory is allocated.
    static void allocated() {
        if (current_ != nullptr && !current_->is_new_) current_->fail("allocated memory");
    }

  private:
    using launch = std::pair<const void*, std::size_t>;

    void compare(const launch& l) {
        if (is_new_)
            expected_->push_back(l);
        else if (next_ >= expected_->size() || (*expected_)[next_] != l)
            fail("launched another kernel or worked on a range of another size");
        ++next_;
    }
    [[noreturn]] void fail(const char* what) const {
        throw error(std::string("a training step ") + what +
                    " although its graph key equals that of an earlier step: add the host value that decides "
                    "about it to the memory_key() of the feature or strategy that reads it");
    }

    std::map<graph_key, std::vector<launch>> launches_;
    std::vector<launch>* expected_ = nullptr;
    std::size_t next_ = 0;
    bool is_new_ = false;
    static inline thread_local key_check* current_ = nullptr;
};

}  // namespace gs::device
