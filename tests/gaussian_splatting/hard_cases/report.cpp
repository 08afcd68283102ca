// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "results.hpp"
#include "table.hpp"

namespace hard_cases {
namespace {

using nlohmann::ordered_json;

constexpr int case_count = 28;

struct column {
    std::string name;
    bool variant;
};

std::vector<column> all_columns() {
    std::vector<column> columns;
    for (const backend& b : backends()) {
        columns.push_back({column_of(b.name, no_variant), false});
        for (const accumulator variant : variants())
            columns.push_back({column_of(b.name, name_of(variant)), true});
    }
    return columns;
}

/// "ok", "FAIL", or "n/a" for a column that a row has no use for.
std::string cell_text(const row& r, const column& c) {
    const auto found = r.cells.find(c.name);
    if (found == r.cells.end() && c.variant != r.has_variants) return "n/a";
    return !r.failed && found != r.cells.end() && found->second == outcome::ok ? "ok" : "FAIL";
}

std::string remarks_of(const row& r) {
    if (r.has_variants) return r.remarks;
    return "no gradients are added up" + (r.remarks.empty() ? "" : "; " + r.remarks);
}

struct named_row {
    std::string test;
    const row* found;
};

/// The rows in the order of the cases, others after them. A case without any test is a row that fails.
std::vector<named_row> sorted_rows() {
    static const row none;
    const results& r = all_results();
    std::vector<named_row> sorted;
    std::set<std::string> taken;
    for (int n = 1; n <= case_count; ++n) {
        const std::string prefix = "case " + std::to_string(n) + ":";
        const auto is_of_case = [&](const std::string& test) { return test.starts_with(prefix); };
        for (const std::string& test : r.order)
            if (is_of_case(test) && taken.insert(test).second) sorted.push_back({test, &r.rows.at(test)});
        if (std::ranges::none_of(r.known, is_of_case)) sorted.push_back({prefix + " has no test", &none});
    }
    for (const std::string& test : r.order)
        if (!r.rows.at(test).cells.empty() && taken.insert(test).second)
            sorted.push_back({test, &r.rows.at(test)});
    return sorted;
}

void print(const std::vector<named_row>& rows, const std::vector<column>& columns) {
    std::string line = "| --- |";
    std::cout << "\n| case |";
    for (const column& c : columns) {
        std::cout << " " << c.name << " |";
        line += " --- |";
    }
    std::cout << " remarks |\n" << line << " --- |\n";
    for (const auto& [test, r] : rows) {
        std::cout << "| " << test << " |";
        for (const column& c : columns) std::cout << " " << cell_text(*r, c) << " |";
        std::cout << " " << remarks_of(*r) << " |\n";
    }
    std::cout << "n/a: each of the row's tests runs with every variant, or none does.\n";
}

ordered_json as_json(const std::vector<named_row>& rows, const std::vector<column>& columns) {
    ordered_json json{{"devices", ordered_json::object()},
                      {"rows", ordered_json::array()},
                      {"against_double", ordered_json::array()}};
    for (const backend& b : backends()) json["devices"][b.name] = b.device_name();
    for (const auto& [test, r] : rows) {
        ordered_json cells;
        for (const column& c : columns) cells[c.name] = cell_text(*r, c);
        json["rows"].push_back({{"case", test}, {"cells", cells}, {"remarks", remarks_of(*r)}});
        for (const auto& [name, a] : r->against_double)
            json["against_double"].push_back({{"scene", test},
                                              {"column", name},
                                              {"error_over_bound", a.error_over_bound},
                                              {"cosine", a.cosine},
                                              {"bias", a.bias}});
    }
    return json;
}

}  // namespace

bool report() {
    const std::vector<named_row> rows = sorted_rows();
    const std::vector<column> columns = all_columns();
    print(rows, columns);
    if (const char* file = std::getenv("WARPAGG_CASES_JSON")) {
        std::ofstream out(file);
        out << as_json(rows, columns).dump(2) << "\n";
        if (!out.flush()) {
            std::cerr << "cannot write " << file << "\n";
            return false;
        }
    }
    for (const auto& [test, r] : rows)
        for (const column& c : columns)
            if (cell_text(*r, c) == "FAIL") return false;
    return true;
}

}  // namespace hard_cases
