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
inline std::vector<accumulator> variants() {
    using namespace gs::lab;
    std::vector<accumulator> all;
    for (const named_accumulator& v : gs::lab::variants) {
        const bool is_alike = v.value == f64 || v.value == compensated || v.value == binned;
        if (!brief || !is_alike) all.push_back(v.value);
    }
    return all;
}
inline std::string name_of(accumulator a) { return std::string(gs::lab::name_of(a)); }

/// Runs a test with each variant of the backward pass on each backend: `test(backend, how)`.
template <class F>
void on_each_variant(const F& test) {
    for (const backend& b : backends())
        for (const accumulator how : variants()) {
            const std::string variant = name_of(how);
            INFO(b.name);
            INFO(variant);
            const cell here(b.name, variant);
            test(b, how);
        }
}

/// A remark for the row of the running test case: what stands in for what, or what was left out and why.
void remark(const std::string& text);

/// How near gradients in float came to those in double, for the cell that we are in.
void record(const agreement& against_double);

}  // namespace hard_cases
