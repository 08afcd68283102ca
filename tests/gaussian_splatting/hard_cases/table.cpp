// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#define DOCTEST_CONFIG_IMPLEMENT
#include "table.hpp"

#include <omp.h>

#include <exception>

#include "results.hpp"

namespace hard_cases {
namespace {

row& here() { return all_results().here(); }

/// Sees every assertion.
struct listener : doctest::IReporter {
    explicit listener(const doctest::ContextOptions&) {}
    void report_query(const doctest::QueryData&) override {}
    void test_run_start() override {}
    void test_run_end(const doctest::TestRunStats&) override {}
    void test_case_start(const doctest::TestCaseData& test) override {
        all_results().test = test.m_name;
        all_results().order.push_back(test.m_name);
        all_results().known.push_back(test.m_name);
        here();
    }
    void test_case_reenter(const doctest::TestCaseData&) override {}
    void test_case_end(const doctest::CurrentTestCaseStats&) override {}
    void test_case_exception(const doctest::TestCaseException&) override { here().failed = true; }
    void subcase_start(const doctest::SubcaseSignature&) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData& assertion) override {
        if (!assertion.m_failed) return;
        const std::string& column = all_results().column;
        if (column.empty())
            here().failed = true;
        else
            here().cells[column] = outcome::failed;
    }
    void log_message(const doctest::MessageData&) override {}
    void test_case_skipped(const doctest::TestCaseData& test) override {
        all_results().known.push_back(test.m_name);
    }
};
DOCTEST_REGISTER_LISTENER("table", 1, listener);

}  // namespace

results& all_results() {
    static results r;
    return r;
}

std::string column_of(const std::string& backend, const std::string& variant) {
    return backend + (variant == no_variant ? "" : " " + variant);
}

cell::cell(const std::string& backend, const std::string& variant) : exceptions_(std::uncaught_exceptions()) {
    all_results().column = column_of(backend, variant);
    if (variant != no_variant) here().has_variants = true;
    here().cells.emplace(all_results().column, outcome::running);
}

cell::~cell() {
    outcome& o = here().cells[all_results().column];
    if (std::uncaught_exceptions() > exceptions_) o = outcome::failed;
    if (o == outcome::running) o = outcome::ok;
    all_results().column.clear();
}

void remark(const std::string& text) {
    std::string& remarks = here().remarks;
    if (!remarks.empty()) remarks += "; ";
    remarks += text;
}

void record(const agreement& against_double) { here().against_double[all_results().column] = against_double; }

}  // namespace hard_cases

int main(int argc, char** argv) {
    omp_set_num_threads(1);  // images are small, and have one order of sums then; some tests ask for more
    doctest::Context context(argc, argv);
    const int failed = context.run();
    if (context.shouldExit()) return failed;
    const bool well = hard_cases::report();
    return failed != 0 || !well ? 1 : 0;
}
