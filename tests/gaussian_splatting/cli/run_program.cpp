// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "run_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <utility>

namespace gs_test {

namespace {

/// Replaces this process by a program, which writes to the two files.
[[noreturn]] void become_program(words command, const fs::path& out, const fs::path& err,
                                 const char* threads) {
    for (const auto& [file, descriptor] : {std::pair(out, STDOUT_FILENO), std::pair(err, STDERR_FILENO)}) {
        const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
    }
    if (threads) setenv("OMP_NUM_THREADS", threads, 1);
    std::signal(SIGINT, SIG_DFL);             // programs in the background ignore it
    setenv("OMP_WAIT_POLICY", "passive", 1);  // waiting threads leave a busy machine to others
    std::vector<char*> argv;
    for (std::string& word : command) argv.push_back(word.data());
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
}

std::string joined(const words& arguments) {
    std::string text;
    for (const std::string& argument : arguments) text += " " + argument;
    return text;
}

}  // namespace

words operator+(words some, const words& more) {
    some.insert(some.end(), more.begin(), more.end());
    return some;
}

outcome run(const words& arguments, const char* threads) {
    return run_and_then(
        arguments, [](pid_t, const fs::path&) {}, threads);
}

outcome run_and_then(const words& arguments, const std::function<void(pid_t, const fs::path&)>& act,
                     const char* threads, const words& launcher) {
    const temporary_folder streams;
    const fs::path out = streams / "out", err = streams / "err";
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) become_program(launcher + words{WARPAGG_PROGRAM} + arguments, out, err, threads);
    act(child, out);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

void check_success(const words& arguments, const char* threads) {
    CAPTURE(joined(arguments));
    const outcome o = run(arguments, threads);
    CHECK(o.err == "");
    REQUIRE(o.code == 0);
}

void check_refusal(const words& arguments, const words& culprits) {
    CAPTURE(joined(arguments));
    const outcome o = run(arguments);
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.err.starts_with("error: "));
    CHECK(std::ranges::count(o.err, '\n') == 1);
    CHECK(o.err.ends_with('\n'));
    for (const std::string& culprit : culprits) {
        CAPTURE(culprit);
        CHECK(says(o.err, {culprit}));
    }
}

void check_refusal_without_trace(const words& arguments, const words& culprits) {
    const temporary_folder folder;
    const fs::path fresh = folder / "new/results", earlier = folder / "earlier";
    check_refusal(arguments + words{"-o", fresh.string()}, culprits);
    CHECK(fs::is_empty(folder.path()));

    write_file(earlier / "metrics.json", "{}\n");
    write_file(earlier / "point_cloud/iteration_10/point_cloud.ply", "ply\n");
    const auto before = contents(earlier);
    const bool trains = arguments.front() == "train";
    check_refusal(arguments + words{"-o", earlier.string()} + (trains ? words{"--overwrite"} : words{}),
                  culprits);
    CHECK(contents(earlier) == before);
}

std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        found[fs::relative(entry.path(), folder).string()] =
            entry.is_regular_file() ? read_file(entry.path()) : "a folder";
    return found;
}

json read_json(const fs::path& file) { return json::parse(read_file(file)); }

fs::path model_of(const fs::path& output, int iteration) {
    return output / "point_cloud" / ("iteration_" + std::to_string(iteration)) / "point_cloud.ply";
}

}  // namespace gs_test
