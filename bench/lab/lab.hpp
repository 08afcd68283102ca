// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// The program for experiments with the trainer's kernels.
namespace gs::lab {

/// The commands of the program. Each parses its own options, of which argv[0] is the command's name, and
/// returns the exit status. Each throws for a problem that the user can solve.
/// @{
int backward(int argc, char** argv);
int paper(int argc, char** argv);
int growth(int argc, char** argv);
int train(int argc, char** argv);
int experiments(int argc, char** argv);  ///< only in builds with CUDA
int trace(int argc, char** argv);        ///< only in builds with CUPTI
/// @}

/// Whether --device ("auto", "cpu" or "cuda") means the GPU. Throws `error` for "cuda" if no GPU can be used.
bool uses_gpu(const std::string& device);

/// Precondition: `x` is not empty.
double median(std::vector<double> x);

}  // namespace gs::lab
