// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <vector>

#include "../core/error.hpp"
#include "shared_memory.hpp"

namespace gs::ranks {

namespace {

using clock = std::chrono::steady_clock;

constexpr int code_of_failure = 1, code_after_another = 75;

volatile pid_t first_rank = 0;
volatile std::sig_atomic_t passed_on = 0;

void pass_on(int number) {
    passed_on = number;
    if (first_rank != 0) kill(first_rank, number);
}

/// While an object exists, the first rank receives the signals of this process. Signals that the
/// process ignores stay ignored.
class signals_to_first_rank {
  public:
    signals_to_first_rank() {
        first_rank = 0;
        passed_on = 0;
        for (std::size_t i = 0; i < count; ++i) {
            sigaction(numbers[i], nullptr, &before_[i]);
            if (before_[i].sa_handler == SIG_IGN) continue;
            struct sigaction action {};
            action.sa_handler = pass_on;
            action.sa_flags = SA_RESTART;
            sigaction(numbers[i], &action, nullptr);
        }
    }
    signals_to_first_rank(const signals_to_first_rank&) = delete;
    signals_to_first_rank& operator=(const signals_to_first_rank&) = delete;
    ~signals_to_first_rank() { restore(); }

    void restore() const {
        for (std::size_t i = 0; i < count; ++i) sigaction(numbers[i], &before_[i], nullptr);
    }

  private:
    static constexpr int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    static constexpr std::size_t count = std::size(numbers);
    struct sigaction before_[count];
};

/// Runs `body` and ends this process.
[[noreturn]] void be_rank(shared_memory& memory, int rank, int count,
                          const std::function<int(communicator&)>& body) {
    shared_memory_transport transport(memory, rank, count);
    communicator all(transport, {rank, count, 0, rank, count});
    int code = code_of_failure;
    try {
        code = body(all);
    } catch (const peer_ended&) {
        code = code_after_another;
    } catch (const std::exception& e) {
        auto& message = memory.messages[static_cast<std::size_t>(rank)];
        std::strncpy(message.data(), e.what(), message.size() - 1);
    }
    // Threads of a library such as NCCL may still use static objects. Destroying these could wait forever.
    std::fflush(nullptr);
    _exit(code);
}

/// The processes of all ranks, as the process that started them sees them.
class rank_processes {
  public:
    rank_processes(shared_memory& memory, int count) : memory_(memory), running_(count), ranks_(count) {}

    void start(const std::function<int(communicator&)>& body, const signals_to_first_rank& signals) {
        const pid_t parent = getpid();
        const int count = static_cast<int>(ranks_.size());
        std::fflush(nullptr);  // otherwise ranks would write buffered output again
        for (int rank = 0; rank < count; ++rank) {
            const pid_t child = fork();
            if (child < 0) {
                kill_all();
                throw error("cannot start rank " + std::to_string(rank) + " of " + std::to_string(count) +
                            ": " + std::strerror(errno));
            }
            if (child == 0) {
                signals.restore();
                // A terminal sends Ctrl-C to its process group, and this process passes it on.
                setpgid(0, 0);
                prctl(PR_SET_PDEATHSIG, SIGKILL);
                if (getppid() != parent) _exit(code_after_another);
                be_rank(memory_, rank, count, body);
            }
            ranks_[static_cast<std::size_t>(rank)].process = child;
            if (rank == 0) first_rank = child;
        }
        if (passed_on != 0) kill(first_rank, passed_on);
    }

    outcome wait() {
        constexpr auto patience = std::chrono::seconds(3);
        clock::time_point last{};
        while (running_ > 0) {
            for (std::size_t r = 0; r < ranks_.size(); ++r) {
                started_rank& one = ranks_[r];
                if (one.has_ended || waitpid(one.process, &one.status, WNOHANG) != one.process) continue;
                one.has_ended = true;
                --running_;
                if (r == 0) first_rank = 0;
                if (r == 0) last = clock::now() + patience;
                if (one.status == 0 || memory_.has_ended.exchange(true)) continue;
                culprit_ = r;
                last = clock::now() + patience;
            }
            const bool must_end = culprit_ < ranks_.size() || ranks_[0].has_ended;
            if (must_end && clock::now() > last) kill_all();
            usleep(2000);
        }
        return result();
    }

  private:
    struct started_rank {
        pid_t process = 0;
        int status = 0;
        bool has_ended = false;
    };

    void kill_all() {
        memory_.has_ended = true;  // so that they are no culprits
        for (const started_rank& one : ranks_)
            if (one.process > 0 && !one.has_ended) kill(one.process, SIGKILL);
    }

    outcome result() const {
        if (culprit_ == ranks_.size()) return {};
        const int first = ranks_[0].status, status = ranks_[culprit_].status;
        const std::string name = "rank " + std::to_string(culprit_) + " of " + std::to_string(ranks_.size());
        if (WIFSIGNALED(status)) {
            const int number = WTERMSIG(status);
            if (culprit_ == 0 && number == passed_on) return {0, "", number};
            return {code_of_failure, name + " was killed by signal " + std::to_string(number) + " (" +
                                         strsignal(number) + ")"};
        }
        const bool first_has_reported = WIFEXITED(first) && WEXITSTATUS(first) != code_after_another &&
                                        memory_.messages[0].front() == '\0';
        if (first_has_reported && WEXITSTATUS(first) != 0) return {WEXITSTATUS(first), ""};
        return {code_of_failure, name + " has failed: " + memory_.messages[culprit_].data()};
    }

    shared_memory& memory_;
    std::size_t running_;
    std::vector<started_rank> ranks_;
    std::size_t culprit_ = ranks_.size();  ///< the first rank that ended early; their number if none did
};

}  // namespace

outcome run(int count, const std::function<int(communicator&)>& body) {
    const auto memory = shared_memory::make();
    const signals_to_first_rank signals;
    rank_processes processes(*memory, count);
    processes.start(body, signals);
    return processes.wait();
}

}  // namespace gs::ranks
