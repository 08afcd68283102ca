// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <string_view>

#include "core/error.hpp"
#include "engine/engine.hpp"
#include "lab.hpp"

namespace {

struct command {
    std::string_view name;
    const char* help;
    int (*run)(int, char**);
};

constexpr std::array commands {
    command{"train", "Trains with any accumulator, or with any rung of the ladder", gs::lab::train},
        command{"backward", "Times each variant of the backward blending", gs::lab::backward},
        command{"paper", "Measures the gradient kernel as the paper's figures show it", gs::lab::paper},
        command{"growth", "Measures time and memory of an iteration of a given size", gs::lab::growth},
#if defined(LAB_WITH_CUDA)
        command{"experiments", "Times ideas for the sums of nine floats", gs::lab::experiments},
#endif
#if defined(LAB_WITH_CUPTI)
        command{"trace", "Records what the GPU does in an iteration of training", gs::lab::trace},
#endif
};

int print_help(std::FILE* to) {
    std::fprintf(to, "Usage: lab COMMAND [OPTIONS]; lab COMMAND --help lists the options.\n\n");
    for (const command& c : commands) std::fprintf(to, "  %-12s %s\n", c.name.data(), c.help);
    return to == stdout ? 0 : 2;
}

}  // namespace

namespace gs::lab {

bool uses_gpu(const std::string& device) {
    std::string reason;
    const bool available = device != "cpu" && gs::train::cuda_is_available(reason);
    if (device == "cuda" && !available) throw gs::error("--device cuda: no GPU can be used: " + reason);
    return available;
}

double median(std::vector<double> x) {
    std::ranges::sort(x);
    return 0.5 * (x[(x.size() - 1) / 2] + x[x.size() / 2]);
}

}  // namespace gs::lab

int main(int argc, char** argv) {
    const std::string_view name = argc > 1 ? argv[1] : "";
    if (name == "-h" || name == "--help") return print_help(stdout);
    const auto* const chosen = std::ranges::find(commands, name, &command::name);
    if (chosen == commands.end()) return print_help(stderr);
    try {
        return chosen->run(argc - 1, argv + 1);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return 2;
    }
}
