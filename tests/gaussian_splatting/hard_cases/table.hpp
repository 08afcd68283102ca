// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "backend.hpp"
#include "bounds.hpp"
#include "budget.hpp"

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

/// The variants of the backward pass that are tested. Under sanitizers `fixed` and `exact` stand for all ways
/// of keeping sums in other than floats: one reports faults, one has cells of many numbers.
inline std::vector<gradient_policy> variants() {
    std::vector<gradient_policy> all;
    for (std::size_t p = 0; p < gs::gradient_policy_names.size(); ++p) {
        const auto policy = static_cast<gradient_policy>(p);
        const bool is_alike = policy == gradient_policy::f64 || policy == gradient_policy::compensated ||
                              policy == gradient_policy::binned;
        if (!brief || !is_alike) all.push_back(policy);
    }
    return all;
}
inline std::string name_of(gradient_policy p) {
    return std::string(gs::gradient_policy_names[static_cast<std::size_t>(p)]);
}

/// Runs a test with each variant of the backward pass on each backend: `test(backend, policy)`.
template <class F>
void on_each_variant(const F& test) {
    for (const backend& b : backends())
        for (const gradient_policy policy : variants()) {
            const std::string variant = name_of(policy);
            INFO(b.name);
            INFO(variant);
            const cell here(b.name, variant);
            test(b, policy);
        }
}

/// A remark for the row of the running test case: what stands in for what, or what was left out and why.
void remark(const std::string& text);

/// How near gradients in float came to those in double, for the cell that we are in.
void record(const agreement& against_double);

}  // namespace hard_cases
