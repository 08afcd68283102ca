// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "mpi.hpp"

#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <numeric>
#include <optional>
#include <vector>

#include "../../core/error.hpp"
#include "../launcher.hpp"

namespace gs::ranks {

namespace {

using clock = std::chrono::steady_clock;

constexpr int code_of_failure = 3, code_after_another = 75;

/// Waits for a request, until a time if there is one. Returns whether it is complete. MPI's own
/// functions that wait would occupy a processor until the slowest rank arrives.
bool wait_for(MPI_Request& request, std::optional<clock::time_point> until = {}) {
    for (patient_wait wait;; wait.after_test()) {
        int is_complete = 0;
        if (MPI_Test(&request, &is_complete, MPI_STATUS_IGNORE) != MPI_SUCCESS) throw peer_ended();
        if (is_complete != 0) return true;
        if (until && clock::now() > *until) return false;
    }
}

/// Shows bytes by MPI's collective functions. A message of fixed size comes first, so that ranks which
/// disagree find out. It has room for small values, which are most frequent.
class mpi_transport final : public transport {
  public:
    mpi_transport(MPI_Comm group, int rank, int count)
        : group_(group),
          rank_(rank),
          heads_(static_cast<std::size_t>(count)),
          sizes_(heads_.size()),
          places_(heads_.size()),
          shown_(heads_.size()) {}

    std::span<const bytes> show(const exchange_label& label, bytes own) override {
        own_ = {label, own.size(), {}};
        if (is_small(own_)) std::ranges::copy(own, own_.bytes.begin());
        MPI_Request request;
        MPI_Iallgather(&own_, sizeof(head), MPI_BYTE, heads_.data(), sizeof(head), MPI_BYTE, group_,
                       &request);
        wait_for(request);
        for (std::size_t r = 0; r < heads_.size(); ++r) {
            if (heads_[r].label != label) throw disagreement(rank_, static_cast<int>(r));
            shown_[r] = bytes(heads_[r].bytes).first(is_small(heads_[r]) ? heads_[r].size : 0);
        }
        if (!std::ranges::all_of(heads_, is_small)) show_large(own);
        return shown_;
    }

  private:
    struct head {
        exchange_label label;
        std::size_t size;
        std::array<std::byte, 488> bytes;
    };
    static bool is_small(const head& h) { return h.size <= h.bytes.size(); }

    void show_large(bytes own) {
        for (std::size_t r = 0; r < heads_.size(); ++r)
            sizes_[r] = is_small(heads_[r]) ? 0 : static_cast<int>(heads_[r].size);
        std::exclusive_scan(sizes_.begin(), sizes_.end(), places_.begin(), 0);
        large_.resize(static_cast<std::size_t>(places_.back() + sizes_.back()));
        MPI_Request request;
        MPI_Iallgatherv(own.data(), sizes_[static_cast<std::size_t>(rank_)], MPI_BYTE, large_.data(),
                        sizes_.data(), places_.data(), MPI_BYTE, group_, &request);
        wait_for(request);
        for (std::size_t r = 0; r < heads_.size(); ++r)
            if (sizes_[r] > 0)
                shown_[r] = bytes(large_).subspan(static_cast<std::size_t>(places_[r]), heads_[r].size);
    }

    MPI_Comm group_;
    int rank_;
    head own_{};
    std::vector<head> heads_;          ///< of all ranks
    std::vector<int> sizes_, places_;  ///< in `large_`, by rank
    std::vector<std::byte> large_;
    std::vector<bytes> shown_;
};

/// MPI from its beginning to its end.
class mpi_session {
  public:
    mpi_session() {
        int threads = MPI_THREAD_SINGLE;
        if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &threads) != MPI_SUCCESS)
            throw error("--mpi: MPI cannot begin");
        MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
        MPI_Comm_dup(MPI_COMM_WORLD, &endings_);
        MPI_Comm_rank(MPI_COMM_WORLD, &place_.rank);
        MPI_Comm_size(MPI_COMM_WORLD, &place_.count);
        MPI_Comm machine;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
        MPI_Comm_rank(machine, &place_.rank_on_machine);
        MPI_Comm_size(machine, &place_.count_on_machine);
        place_.machine = place_.rank;
        MPI_Bcast(&place_.machine, 1, MPI_INT, 0, machine);
        MPI_Comm_free(&machine);
    }
    mpi_session(const mpi_session&) = delete;
    mpi_session& operator=(const mpi_session&) = delete;
    ~mpi_session() { MPI_Finalize(); }

    const ranks::place& place() const { return place_; }

    /// Tells the others how this rank has ended. Returns the exit codes of all, or nothing if one of
    /// them does not end in time.
    std::span<const int> codes_of_all(int own, std::optional<clock::time_point> until) {
        own_code_ = own;
        codes_.resize(static_cast<std::size_t>(place_.count));
        MPI_Request request;
        MPI_Iallgather(&own_code_, 1, MPI_INT, codes_.data(), 1, MPI_INT, endings_, &request);
        try {
            if (wait_for(request, until)) return codes_;
        } catch (const peer_ended&) {
        }
        return {};
    }

  private:
    ranks::place place_;
    MPI_Comm endings_;
    int own_code_ = 0;
    std::vector<int> codes_;
};

/// Returns how long a rank waits for the others to end as well. Others may find the same error a moment
/// later. Lower ranks are less patient, so that only one reports an error that some have.
std::optional<clock::time_point> patience_after(int code, int rank) {
    if (code == 0) return {};
    const int milliseconds = (code == code_after_another ? 10'000 : 2'000) + 50 * rank;
    return clock::now() + std::chrono::milliseconds(milliseconds);
}

void require_all_processes(const place& place) {
    const int started = launch_in_environment().count;
    if (place.count == 1 && started > 1)
        throw error("--mpi: MPI finds 1 of the " + std::to_string(started) +
                    " processes that were started: use the mpirun of the same MPI, or srun --mpi=pmix");
    if (place.count > most_ranks)
        throw error("--mpi: at most " + std::to_string(most_ranks) + " processes can train together, not " +
                    std::to_string(place.count));
}

}  // namespace

std::string mpi_library() {
    std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> name{};
    int length = 0;
    MPI_Get_library_version(name.data(), &length);
    const std::string text(name.data());
    return text.substr(0, text.find_first_of(",\n"));
}

void run_with_mpi(const std::function<int(communicator&)>& body,
                  const std::function<void(const std::string&)>& report) {
    mpi_session session;
    const place& place = session.place();
    require_all_processes(place);
    mpi_transport transport(MPI_COMM_WORLD, place.rank, place.count);
    communicator all(transport, place);
    int code = code_of_failure;
    std::string reason;
    try {
        code = body(all);
    } catch (const peer_ended&) {
        code = code_after_another;
    } catch (const std::exception& e) {
        reason = "rank " + std::to_string(place.rank) + " of " + std::to_string(place.count) +
                 " has failed: " + e.what();
    }
    const auto codes = session.codes_of_all(code, patience_after(code, place.rank));
    const auto failed = std::ranges::find_if(codes, [](int other) { return other != 0; });
    const bool is_first_failed = failed - codes.begin() == place.rank;
    if (!reason.empty() && (codes.empty() || is_first_failed)) report(reason);
    std::fflush(nullptr);
    if (codes.empty()) MPI_Abort(MPI_COMM_WORLD, code);
    MPI_Finalize();
    // Destroying static objects could wait forever: see `ranks::run`.
    _exit(failed == codes.end() ? 0 : *failed);
}

}  // namespace gs::ranks
