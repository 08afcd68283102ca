// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <sstream>
#include <string_view>
#include <thread>

namespace gs::poses {
namespace {

constexpr std::array<int, 3> forwarded_signals{SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t running_child = 0;
volatile std::sig_atomic_t received_signal = 0;

/// The first signal asks the group of the child to end; further ones end it.
void end_child(int signal) {
    if (running_child > 0) kill(-running_child, received_signal == 0 ? SIGTERM : SIGKILL);
    received_signal = signal;
}

/// While it exists, the signals end the child instead of this process. Ignored signals stay
/// ignored.
class forward_signals {
  public:
    forward_signals() {
        received_signal = 0;
        struct sigaction forward {};
        forward.sa_handler = end_child;
        for (std::size_t i = 0; i < forwarded_signals.size(); ++i) {
            sigaction(forwarded_signals[i], nullptr, &earlier_[i]);
            if (earlier_[i].sa_handler != SIG_IGN) sigaction(forwarded_signals[i], &forward, nullptr);
        }
    }
    forward_signals(const forward_signals&) = delete;
    forward_signals& operator=(const forward_signals&) = delete;
    ~forward_signals() {
        for (std::size_t i = 0; i < forwarded_signals.size(); ++i)
            sigaction(forwarded_signals[i], &earlier_[i], nullptr);
    }

  private:
    std::array<struct sigaction, forwarded_signals.size()> earlier_{};
};

/// The reading and the writing end of a pipe. A child does not inherit them.
class pipe_ends {
  public:
    pipe_ends() {
        if (pipe2(ends_, O_CLOEXEC) != 0)
            throw error(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    pipe_ends(const pipe_ends&) = delete;
    pipe_ends& operator=(const pipe_ends&) = delete;
    ~pipe_ends() {
        close_reading_end();
        close_writing_end();
    }

    int reading_end() const { return ends_[0]; }
    int writing_end() const { return ends_[1]; }
    void close_reading_end() {
        if (ends_[0] >= 0) close(ends_[0]);
        ends_[0] = -1;
    }
    void close_writing_end() {
        if (ends_[1] >= 0) close(ends_[1]);
        ends_[1] = -1;
    }

  private:
    int ends_[2] = {-1, -1};
};

/// Returns the variables of this process. With the last one, COLMAP needs no display.
std::vector<std::string> child_environment() {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable; ++variable)
        if (!std::string(*variable).starts_with("QT_QPA_PLATFORM=")) variables.emplace_back(*variable);
    variables.emplace_back("QT_QPA_PLATFORM=offscreen");
    return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

constexpr int no_input = -1;

/// Starts the program as the leader of its own process group.
pid_t start(const std::string& program, const std::vector<std::string>& arguments, int output,
            int input = no_input) {
    std::vector<std::string> argument_texts{program}, variables = child_environment();
    argument_texts.insert(argument_texts.end(), arguments.begin(), arguments.end());
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    if (input == no_input)
        posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    else
        posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, program.c_str(), &files, &attributes,
                                    pointers_to(argument_texts).data(), pointers_to(variables).data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (failed != 0) throw error("cannot start " + program + ": " + std::strerror(failed));
    return child;
}

void read_lines(int from, const std::function<void(const std::string&)>& on_line) {
    constexpr std::size_t longest_line = 65536;
    std::array<char, 4096> buffer;
    std::string line;
    while (true) {
        const ssize_t count = read(from, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        for (const char c : std::string_view(buffer.data(), static_cast<std::size_t>(count))) {
            const bool ends = c == '\n' || c == '\r';
            if (!ends && line.size() < longest_line) line += c;
            if (!ends || line.empty()) continue;
            on_line(line);
            line.clear();
        }
    }
    if (!line.empty()) on_line(line);
}

int wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    running_child = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Writes all bytes. Returns false if nobody reads them.
bool write_all(int to, const std::vector<std::uint8_t>& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = write(to, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

/// While it exists, a write to a pipe without a reader fails instead of ending this process.
class ignore_broken_pipes {
  public:
    ignore_broken_pipes() : earlier_(std::signal(SIGPIPE, SIG_IGN)) {}
    ignore_broken_pipes(const ignore_broken_pipes&) = delete;
    ignore_broken_pipes& operator=(const ignore_broken_pipes&) = delete;
    ~ignore_broken_pipes() { std::signal(SIGPIPE, earlier_); }

  private:
    void (*earlier_)(int);
};

}  // namespace

bool is_installed(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
    return false;
}

int run_child(const std::string& program, const std::vector<std::string>& arguments,
              const std::function<void(const std::string& line)>& on_line) {
    const forward_signals forwarding;
    pipe_ends output;
    const pid_t child = start(program, arguments, output.writing_end());
    running_child = child;
    if (received_signal != 0) kill(-child, SIGTERM);  // it came before the child was known
    output.close_writing_end();
    try {
        read_lines(output.reading_end(), on_line);
    } catch (...) {
        kill(-child, SIGKILL);
        wait_for(child);
        throw;
    }
    const int status = wait_for(child);
    if (received_signal != 0) throw interrupted(received_signal, program + " was interrupted");
    return status;
}

int feed_child(const std::string& program, const std::vector<std::string>& arguments,
               const std::function<std::vector<std::uint8_t>()>& next,
               const std::function<void(const std::string& line)>& on_line) {
    const forward_signals forwarding;
    const ignore_broken_pipes ignoring;
    pipe_ends output, input;
    const pid_t child = start(program, arguments, output.writing_end(), input.reading_end());
    running_child = child;
    if (received_signal != 0) kill(-child, SIGTERM);  // it came before the child was known
    output.close_writing_end();
    input.close_reading_end();
    std::vector<std::string> lines;
    std::thread reader(
        [&] { read_lines(output.reading_end(), [&](const std::string& line) { lines.push_back(line); }); });
    std::exception_ptr failed;
    try {
        for (auto bytes = next(); !bytes.empty() && received_signal == 0; bytes = next())
            if (!write_all(input.writing_end(), bytes)) break;
    } catch (...) {
        failed = std::current_exception();
        kill(-child, SIGKILL);
    }
    input.close_writing_end();
    reader.join();
    const int status = wait_for(child);
    if (failed) std::rethrow_exception(failed);
    if (received_signal != 0) throw interrupted(received_signal, program + " was interrupted");
    for (const std::string& line : lines) on_line(line);
    return status;
}

}  // namespace gs::poses
