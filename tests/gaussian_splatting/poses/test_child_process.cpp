// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "poses/child_process.hpp"

using namespace gs::poses;
using lines = std::vector<std::string>;

namespace {

struct finished {
    int status;
    lines output;
};

finished run_script(const std::string& script, const lines& arguments = {}) {
    lines all{"-c", script, "sh"}, output;
    all.insert(all.end(), arguments.begin(), arguments.end());
    const int status = run_child("sh", all, [&](const std::string& line) { output.push_back(line); });
    return {status, output};
}

/// Whether the process with this number ends, apart from being collected by its parent.
bool ends_soon(const std::string& process) {
    for (int attempt = 0; attempt < 500; ++attempt) {
        const std::string state = gs_test::read_file("/proc/" + process + "/stat");
        if (state.empty() || state.find(") Z") != std::string::npos) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace

TEST_CASE("a child process receives its arguments unchanged and empty input") {
    const finished child = run_script("cat; printf '%s\\n' \"$@\"", {"a b", "it's \"$HOME\"", "*"});
    CHECK(child.status == 0);
    CHECK(child.output == lines{"a b", "it's \"$HOME\"", "*"});
}

TEST_CASE("lines of a child's output end with newlines or carriage returns") {
    CHECK(run_script("printf 'one\\rtwo\\n\\nthree' >&2").output == lines{"one", "two", "three"});
    const lines output = run_script("head -c 200000 /dev/zero | tr '\\0' x; echo; echo end").output;
    REQUIRE(output.size() == 2);
    CHECK(output[0] == std::string(65536, 'x'));
    CHECK(output[1] == "end");
}

TEST_CASE("a child's exit status includes the signal that ended it") {
    CHECK(run_script("exit 3").status == 3);
    CHECK(run_script("kill -SEGV $$").status == 128 + SIGSEGV);
}

TEST_CASE("children need no display") {
    CHECK(run_script("echo $QT_QPA_PLATFORM").output == lines{"offscreen"});
}

TEST_CASE("a program that does not exist is reported") {
    CHECK_FALSE(is_installed("no-such-program"));
    CHECK(is_installed("sh"));
    CHECK(gs_test::says(gs_test::error_of([] { run_child("no-such-program", {}, [](const auto&) {}); }),
                        {"cannot start no-such-program", "No such file"}));
}

TEST_CASE("a signal ends the child and its own children") {
    for (const int signal : {SIGINT, SIGTERM}) {
        CAPTURE(signal);
        std::signal(signal, SIG_DFL);  // a shell may have started the test with ignored signals
        std::string grandchild;
        const auto start = std::chrono::steady_clock::now();
        CHECK_THROWS_AS(run_child("sh", {"-c", "sleep 60 & echo $!; wait"},
                                  [&](const std::string& line) {
                                      grandchild = line;
                                      std::raise(signal);
                                  }),
                        interrupted);
        CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(50));
        CHECK(ends_soon(grandchild));
    }
}

TEST_CASE("an exception from the function for lines ends the child") {
    std::string child;
    CHECK_THROWS_AS(run_child("sh", {"-c", "echo $$; sleep 60"},
                              [&](const std::string& line) {
                                  child = line;
                                  throw gs::error("stop");
                              }),
                    gs::error);
    CHECK(ends_soon(child));
}
