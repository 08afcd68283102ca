// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "exit_code.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "../core/error.hpp"
#include "highlighted.hpp"
#include "stop_signals.hpp"

namespace gs::cli {

namespace {

void print_error(const std::string& sentence) {
    std::fprintf(stderr, "%s %s\n", highlighted("error:", message_color::red, stderr).c_str(),
                 sentence.c_str());
}

}  // namespace

int exit_code_of(const std::function<void()>& command) {
    try {
        command();
        return 0;
    } catch (const reported_failure& e) {
        return e.code;
    } catch (const interruption& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 128 + e.signal;
    } catch (const error& e) {
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

}  // namespace gs::cli
