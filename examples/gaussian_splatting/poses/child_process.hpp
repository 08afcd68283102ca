// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../core/error.hpp"

namespace gs::poses {

/// Reports that a signal, such as Ctrl-C, ended the child process.
struct interrupted : error {
    interrupted(int number, const std::string& message) : error(message), signal(number) {}
    int signal;
};

/// Returns whether the program is in a folder of PATH.
bool is_installed(const std::string& program);

/// Runs a program without a shell, and returns its exit status, or 128 plus the number of the
/// signal that ended it. Its input is empty. Calls `on_line` for each line of its output and error
/// output that is not empty. Carriage returns end lines, too. Lines are cut after 64 KiB.
///
/// SIGINT, SIGTERM or SIGHUP end the program and its own child processes; the function then throws
/// `interrupted`. The program also ends if `on_line` throws. Throws `error` if the program cannot
/// be started. Precondition: no other thread calls this function at the same time.
int run_child(const std::string& program, const std::vector<std::string>& arguments,
              const std::function<void(const std::string& line)>& on_line);

/// Runs a program like `run_child`, and writes to its input what `next` returns, until that is empty
/// or the program reads no more. If `next` throws, the program ends. Calls `on_line` after the program
/// has ended.
int feed_child(const std::string& program, const std::vector<std::string>& arguments,
               const std::function<std::vector<std::uint8_t>()>& next,
               const std::function<void(const std::string& line)>& on_line);

}  // namespace gs::poses
