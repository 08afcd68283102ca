// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/parse.hpp"
#include "cli/train_in_ranks.hpp"
#include "core/error.hpp"

namespace {

void run(const gs::cli::settings& settings) {
    switch (settings.command) {
        case gs::cli::command::train:
            return gs::cli::train(settings);
        case gs::cli::command::evaluate:
            return gs::cli::evaluate(settings);
        case gs::cli::command::render:
            return gs::cli::render(settings);
        case gs::cli::command::compare:
            return gs::cli::compare(settings);
        case gs::cli::command::convert:
            return gs::cli::convert(settings);
        case gs::cli::command::view:
            return gs::cli::view_model(settings);
        case gs::cli::command::inspect:
            return gs::cli::inspect(settings);
        case gs::cli::command::doctor:
            return gs::cli::doctor();
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    return gs::cli::exit_code_of([&] {
#if defined(__AVX2__)
        if (!__builtin_cpu_supports("avx2"))
            throw gs::error(
                "this program was built for CPUs with AVX2: build it with -DWARPAGG_CPU_ARCH=native here");
#endif
        try {
            run(gs::cli::parse(arguments));
        } catch (const gs::error&) {
            if (std::ranges::find(arguments, "--mpi") != arguments.end())
                gs::cli::leave_error_to_first_process();
            throw;
        }
    });
}
