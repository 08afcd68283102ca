// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// y = A^T x for a sparse A in CSR, e.g. the gradient of a linear model. A lane walks a row, so a column that
/// many rows have at the same place is hit by many lanes at once.

#include "common/compare.hpp"
#include "common/data.hpp"

using namespace warpagg;

template <class Policy>
struct transposed_spmv {
    const unsigned* row_begin;  // rows + 1 of them
    const unsigned* columns;
    const float* values;
    const float* x;
    unsigned rows;
    float* y;

    WARPAGG_HD unsigned lanes() const { return rows; }

    WARPAGG_EXEC_CHECK_DISABLE
    template <warp W>
    WARPAGG_HD void operator()(const W& w, unsigned first) const {
        const auto is_row = w.lane() + first < rows;
        const auto x_of_row = w.load_row(x, first, is_row);
        const auto end = w.load_row(row_begin, first + 1, is_row);
        auto at = w.load_row(row_begin, first, is_row);
        auto active = at < end;
        while (!skip_if_warp_idle(w, active)) {  // until the longest of the warp's rows ends
            const auto column = w.load(columns, at, active);
            const value_t<W, float> product[1] = {w.load(values, at, active) * x_of_row};
            warp_match_reduce_atomic(w, y, column, product, active, Policy{});
            at += 1u;
            active = at < end;
        }
    }
};

struct matrix {
    std::vector<unsigned> row_begin{0}, columns;
    std::vector<float> values;
};

/// Rows of up to 8 columns each, chosen by `column(row, i)`, with small integers as values.
template <class F>
matrix make(unsigned rows, const F& column) {
    matrix a;
    for (unsigned row = 0; row < rows; ++row) {
        const unsigned length = 1 + example::random_below(8);
        for (unsigned i = 0; i < length; ++i) {
            a.columns.push_back(column(row, i));
            a.values.push_back(static_cast<float>(example::random_below(4)) - 1.0f);
        }
        a.row_begin.push_back(static_cast<unsigned>(a.columns.size()));
    }
    return a;
}

int main(int argc, char** argv) {
    return example::run(
        "Sparse matrix-transpose product", "rows of 1 to 8 values", argc, argv, [](unsigned n) {
            std::vector<float> x_values(n);
            for (float& v : x_values) v = static_cast<float>(example::random_below(3)) - 1.0f;
            example::machine::array<float> x(x_values), y(n);

            const auto multiply = [&](const char* name, const matrix& a) {
                example::exact_sums expected(n, 1);
                for (unsigned row = 0; row < n; ++row)
                    for (unsigned i = a.row_begin[row]; i < a.row_begin[row + 1]; ++i)
                        expected.add(a.columns[i], a.values[i] * x_values[row]);
                example::machine::array<unsigned> row_begin(a.row_begin), columns(a.columns);
                example::machine::array<float> values(a.values);
                example::compare(name, y, expected.values(), [&](auto policy) {
                    return transposed_spmv<decltype(policy)>{
                        row_begin.data(), columns.data(), values.data(), x.data(), n, y.data()};
                });
            };
            multiply("banded", make(n, [&](unsigned row, unsigned i) { return (row + i) % n; }));
            multiply("random", make(n, [&](unsigned, unsigned) { return example::random_below(n); }));
            multiply("random, one dense column",
                     make(n, [&](unsigned, unsigned i) { return i == 0 ? 0 : example::random_below(n); }));
        });
}
