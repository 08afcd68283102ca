// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#define DOCTEST_CONFIG_IMPLEMENT
#include "table.hpp"

#include <omp.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <vector>

namespace hard_cases {
namespace {

constexpr int case_count = 27;

enum class outcome { running, ok, failed };

struct row {
    std::string remarks;
    std::map<std::string, outcome> cells;  ///< by column
    bool has_variants = false;
    bool failed = false;  ///< outside of the cells
};

/// What is known of the run so far. Tests run one after another.
struct results {
    std::map<std::string, row> rows;  ///< by test case
    std::vector<std::string> order;
    std::string test, column;  ///< where we are; no column outside of a cell
};

results& all() {
    static results r;
    return r;
}

row& here() { return all().rows[all().test]; }

std::string column_of(const std::string& backend, const std::string& variant) {
    return backend + (variant == no_variant ? "" : " " + variant);
}

/// Sees every assertion.
struct listener : doctest::IReporter {
    explicit listener(const doctest::ContextOptions&) {}
    void report_query(const doctest::QueryData&) override {}
    void test_run_start() override {}
    void test_run_end(const doctest::TestRunStats&) override {}
    void test_case_start(const doctest::TestCaseData& test) override {
        all().test = test.m_name;
        all().order.push_back(test.m_name);
        here();
    }
    void test_case_reenter(const doctest::TestCaseData&) override {}
    void test_case_end(const doctest::CurrentTestCaseStats&) override {}
    void test_case_exception(const doctest::TestCaseException&) override { here().failed = true; }
    void subcase_start(const doctest::SubcaseSignature&) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData& assertion) override {
        if (!assertion.m_failed) return;
        if (all().column.empty())
            here().failed = true;
        else
            here().cells[all().column] = outcome::failed;
    }
    void log_message(const doctest::MessageData&) override {}
    void test_case_skipped(const doctest::TestCaseData&) override {}
};
DOCTEST_REGISTER_LISTENER("table", 1, listener);

std::vector<std::string> columns_of(const backend& b, bool variants) {
    if (!variants) return {b.name};
    std::vector<std::string> columns;
    for (const auto name : gs::gradient_policy_names) columns.push_back(column_of(b.name, std::string(name)));
    return columns;
}

/// "ok", "FAIL", or "n/a" for a column that a row has no use for.
std::string cell_text(const row& r, const std::string& column, bool variant) {
    const auto found = r.cells.find(column);
    if (found == r.cells.end() && variant != r.has_variants) return "n/a";
    return !r.failed && found != r.cells.end() && found->second == outcome::ok ? "ok" : "FAIL";
}

/// The rows in the order of the cases; with those that did not run if all were to.
std::vector<std::pair<std::string, row>> rows(bool all_were_to) {
    std::vector<std::pair<std::string, row>> sorted;
    std::set<std::string> taken;
    for (int n = 1; n <= case_count; ++n) {
        const std::string prefix = "case " + std::to_string(n) + ":";
        bool found = false;
        for (const std::string& test : all().order)
            if (test.rfind(prefix, 0) == 0 && taken.insert(test).second) {
                sorted.emplace_back(test, all().rows[test]);
                found = true;
            }
        if (!found && all_were_to) sorted.emplace_back(prefix + " did not run", row{});
    }
    for (const std::string& test : all().order)
        if (taken.insert(test).second && !all().rows[test].cells.empty())
            sorted.emplace_back(test, all().rows[test]);
    return sorted;
}

std::string quoted(const std::string& text) {
    std::string json = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') json += '\\';
        json += c;
    }
    return json + "\"";
}

/// Prints the table, and writes it as JSON to the file that WARPAGG_CASES_JSON names. Whether all is well.
bool report(bool all_were_to) {
    struct column {
        std::string name;
        bool variant;
    };
    std::vector<column> columns;
    for (const backend& b : backends())
        for (const bool variants : {false, true})
            for (const std::string& name : columns_of(b, variants)) columns.push_back({name, variants});

    std::string text = "\n| case |", line = "\n| --- |", json = "{\"rows\": [";
    for (const column& c : columns) {
        text += " " + c.name + " |";
        line += " --- |";
    }
    text += " remarks |" + line + " --- |\n";
    bool well = true;
    const char* comma = "\n";
    for (const auto& [test, r] : rows(all_were_to)) {
        text += "| " + test + " |";
        json += comma + ("{\"case\": " + quoted(test)) + ", \"cells\": {";
        comma = ",\n";
        const char* between = "";
        for (const column& c : columns) {
            const std::string found = cell_text(r, c.name, c.variant);
            well = well && found != "FAIL";
            text += " " + found + " |";
            json += between + quoted(c.name) + ": " + quoted(found);
            between = ", ";
        }
        const std::string why = (r.has_variants ? "" : "no gradients are added up; ") + r.remarks;
        text += " " + why + " |\n";
        json += "}, \"remarks\": " + quoted(why) + "}";
    }
    std::cout << text << "n/a: each of the row's tests runs with every variant, or none does.\n";
    if (const char* file = std::getenv("WARPAGG_CASES_JSON")) {
        std::ofstream out(file);
        out << json << "\n]}\n";
        if (!out.flush()) {
            std::cerr << "cannot write " << file << "\n";
            return false;
        }
    }
    return well;
}

}  // namespace

cell::cell(const std::string& backend, const std::string& variant) : exceptions_(std::uncaught_exceptions()) {
    all().column = column_of(backend, variant);
    if (variant != no_variant) here().has_variants = true;
    here().cells.emplace(all().column, outcome::running);
}

cell::~cell() {
    outcome& o = here().cells[all().column];
    if (std::uncaught_exceptions() > exceptions_) o = outcome::failed;
    if (o == outcome::running) o = outcome::ok;
    all().column.clear();
}

void remark(const std::string& text) {
    std::string& remarks = here().remarks;
    if (!remarks.empty()) remarks += "; ";
    remarks += text;
}

}  // namespace hard_cases

int main(int argc, char** argv) {
    omp_set_num_threads(1);  // pictures are small, and have one order of sums then; some tests ask for more
    doctest::Context context(argc, argv);
    const int failed = context.run();
    if (context.shouldExit()) return failed;
    const bool well = hard_cases::report(argc == 1);  // with arguments it may be some of the cases
    return failed != 0 || !well ? 1 : 0;
}
