// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <string>

#include "backend.hpp"
#include "bounds.hpp"

namespace hard_cases {

/// Where in the table of results a test stands: in the row of its test case, in the column of a backend and a
/// variant of the backward pass. Assertions that fail while it lives are that cell's failures, and so is an
/// exception that ends it.
class cell {
  public:
    cell(const std::string& backend, const std::string& variant);
    cell(const cell&) = delete;
    cell& operator=(const cell&) = delete;
    ~cell();

  private:
    int exceptions_;
};

inline constexpr const char* no_variant = "-";

/// Runs a test that no backward pass takes part in, once a backend: `test(backend)`.
template <class F>
void on_each_backend(const F& test) {
    for (const backend& b : backends()) {
        INFO(b.name);
        const cell here(b.name, no_variant);
        test(b);
    }
}

/// Runs a test with each variant of the backward pass on each backend: `test(backend, policy)`.
template <class F>
void on_each_variant(const F& test) {
    for (const backend& b : backends())
        for (std::size_t p = 0; p < gs::gradient_policy_names.size(); ++p) {
            const std::string variant(gs::gradient_policy_names[p]);
            INFO(b.name);
            INFO(variant);
            const cell here(b.name, variant);
            test(b, static_cast<gradient_policy>(p));
        }
}

/// A remark for the row of the running test case: what stands in for what, or what was left out and why.
void remark(const std::string& text);

/// How near gradients in float came to those in double, for the cell that we are in.
void record(const agreement& against_double);

}  // namespace hard_cases
