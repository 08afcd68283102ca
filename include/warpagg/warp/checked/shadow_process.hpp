// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "../../core/call_site.hpp"
#include "sanitizers.hpp"

namespace warpagg::emulator::detail {

/// Finds out whether memory depends on garbage. When a lane first reads an undefined value, the process
/// forks: the child goes on with other garbage and the same schedule, and both keep a list of what lanes
/// write. What differs depends on the garbage, by whatever way: sums, comparisons, branches. The child prints
/// nothing and ends with the launch.
class twin {
  public:
    struct write {
        call_site at;
        unsigned block, thread;
        std::size_t reads_before;  ///< how many undefined values had been read
    };

    twin() = default;
    twin(const twin&) = delete;
    twin& operator=(const twin&) = delete;
    ~twin() {
        if (child_ <= 0) return;
        close(pipe_);
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }

    bool is_child() const { return child_ == 0; }

    /// At an undefined read. Only the first forks.
    void split() {
        if (child_ >= 0) return;
        int ends[2];
        if (pipe(ends) != 0 || (child_ = fork()) < 0) {
            std::perror("warpagg: cannot fork, to see whether memory depends on an undefined value");
            std::abort();
        }
        pipe_ = ends[is_child() ? 1 : 0];
        close(ends[is_child() ? 0 : 1]);
        if (is_child()) {
            sanitizers::forked() = true;
            // What the kernel prints has been seen once.
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDOUT_FILENO);
            dup2(nowhere, STDERR_FILENO);
        }
    }

    /// Something is about to be written, or an atomic's operand to be combined.
    void note(const write& who, const void* address, const void* value, std::size_t size) {
        if (child_ < 0) return;
        std::uint64_t hash = 0xcbf29ce484222325u ^ who.thread ^ (std::uint64_t{who.block} << 32);
        const auto mix = [&hash](std::uint64_t bits) {
            hash = (hash ^ bits) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
        };
        mix(reinterpret_cast<std::uintptr_t>(address));
        for (std::size_t i = 0; i < size; ++i) mix(static_cast<const unsigned char*>(value)[i]);
        hashes_.push_back(hash);
        if (!is_child()) writes_.push_back(who);
    }

    /// In the child: hands the list over and ends the process.
    [[noreturn]] void hand_over() {
        const char* first = reinterpret_cast<const char*>(hashes_.data());
        for (std::size_t left = hashes_.size() * sizeof hashes_[0]; left > 0;) {
            const ssize_t written = ::write(pipe_, first, left);
            if (written <= 0) _exit(EXIT_FAILURE);
            first += written;
            left -= static_cast<std::size_t>(written);
        }
        close(pipe_);  // whereupon the parent goes on, whatever else happens at the end of a process
        _exit(EXIT_SUCCESS);
    }

    /// In the parent, after the launch: whether the child wrote something else, or did not end within a
    /// minute.
    bool differs() {
        if (child_ < 0) return false;
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
    /// After `differs`: the first write that the child did not make so; null if all were the same and the
    /// child made more.
    const write* first_difference() const {
        return first_difference_ < writes_.size() ? &writes_[first_difference_] : nullptr;
    }

  private:
    pid_t child_ = -1;  // none yet
    int pipe_ = -1;
    std::vector<std::uint64_t> hashes_;
    std::vector<write> writes_;
    std::size_t first_difference_ = 0;
};

}  // namespace warpagg::emulator::detail
