// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Enables shadow processes, with which the model `checked` diagnoses all writes that depend on undefined
/// values. Include this header in exactly one source file of a test program. Without it, `checked` diagnoses
/// only written floats and doubles that are undefined or computed from undefined ones. Requires POSIX. Cost:
/// one fork per launch that reads an undefined value.

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "checked/sanitizers.hpp"
#include "checked/shadow_process.hpp"

namespace warpagg::emulator::detail {

/// A shadow process made by fork(). The child prints nothing and ends with the launch.
class forked_shadow_process final : public shadow_process {
  public:
    /// Forks this process. Aborts the program if that fails.
    forked_shadow_process() {
        int ends[2];
        if (pipe(ends) != 0 || (child_ = fork()) < 0) {
            std::perror("warpagg: cannot fork, to see whether memory depends on an undefined value");
            std::abort();
        }
        pipe_ = ends[child_ == 0 ? 1 : 0];
        close(ends[child_ == 0 ? 0 : 1]);
        if (child_ == 0) {
            sanitizers::forked() = true;
            // Only the parent shows the kernel's output.
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDOUT_FILENO);
            dup2(nowhere, STDERR_FILENO);
        }
    }
    forked_shadow_process(const forked_shadow_process&) = delete;
    forked_shadow_process& operator=(const forked_shadow_process&) = delete;
    ~forked_shadow_process() override {
        close(pipe_);
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }

    bool is_child() const override { return child_ == 0; }

    void note(const write& who, const void* address, const void* value, std::size_t size) override {
        std::uint64_t hash = 0xcbf29ce484222325u ^ who.thread ^ (std::uint64_t{who.block} << 32);
        const auto mix = [&hash](std::uint64_t bits) {
            hash = (hash ^ bits) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
        };
        mix(reinterpret_cast<std::uintptr_t>(address));
        for (std::size_t i = 0; i < size; ++i) mix(static_cast<const unsigned char*>(value)[i]);
        hashes_.push_back(hash);
        if (child_ != 0) writes_.push_back(who);
    }

    [[noreturn]] void hand_over() override {
        const char* first = reinterpret_cast<const char*>(hashes_.data());
        for (std::size_t left = hashes_.size() * sizeof hashes_[0]; left > 0;) {
            const ssize_t written = ::write(pipe_, first, left);
            if (written <= 0) _exit(EXIT_FAILURE);
            first += written;
            left -= static_cast<std::size_t>(written);
        }
        close(pipe_);  // the parent continues here and does not wait for the exit
        _exit(EXIT_SUCCESS);
    }

    bool differs() override {
        std::vector<std::uint64_t> theirs(hashes_.size() + 1);
        const std::size_t wanted = theirs.size() * sizeof theirs[0];
        std::size_t size = 0;
        for (pollfd events{pipe_, POLLIN, 0}; size < wanted && poll(&events, 1, 60'000) == 1;) {
            const ssize_t got = read(pipe_, reinterpret_cast<char*>(theirs.data()) + size, wanted - size);
            if (got <= 0) break;
            size += static_cast<std::size_t>(got);
        }
        theirs.resize(size / sizeof theirs[0]);
        first_difference_ = 0;
        while (first_difference_ < hashes_.size() && first_difference_ < theirs.size() &&
               hashes_[first_difference_] == theirs[first_difference_])
            ++first_difference_;
        return first_difference_ < hashes_.size() || theirs.size() > hashes_.size();
    }
    const write* first_difference() const override {
        return first_difference_ < writes_.size() ? &writes_[first_difference_] : nullptr;
    }

  private:
    pid_t child_ = -1;
    int pipe_ = -1;
    std::vector<std::uint64_t> hashes_;
    std::vector<write> writes_;
    std::size_t first_difference_ = 0;
};

/// Starts a shadow process. It is not inline, so that two inclusions in one program fail to link.
std::unique_ptr<shadow_process> fork_shadow_process() { return std::make_unique<forked_shadow_process>(); }

namespace {
[[maybe_unused]] const bool forks_shadow_processes = (start_shadow_process = fork_shadow_process, true);
}  // namespace

}  // namespace warpagg::emulator::detail
