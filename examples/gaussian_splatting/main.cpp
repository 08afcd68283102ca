// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "cli/commands.hpp"
#include "cli/highlighted.hpp"
#include "cli/parse.hpp"
#include "cli/stop_signals.hpp"
#include "core/error.hpp"

namespace {

void print_error(const std::string& sentence) {
    std::fprintf(stderr, "%s %s\n",
                 gs::cli::highlighted("error:", gs::cli::message_color::red, stderr).c_str(),
                 sentence.c_str());
}

}  // namespace

int main(int argc, char** argv) {
    try {
#if defined(__AVX2__)
        if (!__builtin_cpu_supports("avx2"))
            throw gs::error(
                "this program was built for CPUs with AVX2: build it with -DWARPAGG_CPU_ARCH=native here");
#endif
        const gs::cli::settings settings = gs::cli::parse({argv + 1, argv + argc});
        switch (settings.command) {
            case gs::cli::command::train:
                gs::cli::train(settings);
                break;
            case gs::cli::command::evaluate:
                gs::cli::evaluate(settings);
                break;
            case gs::cli::command::render:
                gs::cli::render(settings);
                break;
            case gs::cli::command::compare:
                gs::cli::compare(settings);
                break;
            case gs::cli::command::convert:
                gs::cli::convert(settings);
                break;
            case gs::cli::command::view:
                gs::cli::view_model(settings);
                break;
            case gs::cli::command::inspect:
                gs::cli::inspect(settings);
                break;
            case gs::cli::command::doctor:
                gs::cli::doctor();
                break;
        }
        return 0;
    } catch (const gs::cli::interruption& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 128 + e.signal;
    } catch (const gs::error& e) {
        print_error(e.what());
        return 2;
    } catch (const std::filesystem::filesystem_error& e) {
        print_error("cannot use " + e.path1().string() + ": " + e.code().message());
        return 2;
    } catch (const std::bad_alloc&) {
        print_error("out of memory: lower --resolution or --max-cap");
        return 3;
    } catch (const std::exception& e) {
        print_error(e.what());
        return 3;
    }
}
