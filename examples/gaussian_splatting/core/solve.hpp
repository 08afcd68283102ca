// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace gs {

/// Solves matrix * x = right by Cholesky factorization. `Value` is a number or a vector of numbers.
/// Precondition: the matrix is symmetric and positive definite. Reads its lower triangle.
template <std::size_t N, class Value>
std::array<Value, N> solve(std::array<std::array<double, N>, N> matrix, std::array<Value, N> right) {
    for (std::size_t a = 0; a < N; ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
            for (std::size_t k = 0; k < b; ++k) matrix[a][b] -= matrix[a][k] * matrix[b][k];
            matrix[a][b] = a == b ? std::sqrt(matrix[a][a]) : matrix[a][b] / matrix[b][b];
        }
        for (std::size_t k = 0; k < a; ++k) right[a] -= matrix[a][k] * right[k];
        right[a] /= matrix[a][a];
    }
    for (std::size_t a = N; a-- > 0;) {
        for (std::size_t k = a + 1; k < N; ++k) right[a] -= matrix[k][a] * right[k];
        right[a] /= matrix[a][a];
    }
    return right;
}

}  // namespace gs
