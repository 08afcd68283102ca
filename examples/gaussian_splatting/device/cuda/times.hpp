// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nvtx3/nvToolsExt.h>

#include <array>

#include "../stages.hpp"
#include "memory.hpp"

namespace gs::device {

/// Times the stages of every n-th iteration by events; timing every iteration would slow down
/// training. Profilers see the stages of all iterations as NVTX ranges.
class cuda_times {
  public:
    explicit cuda_times(cudaStream_t stream) : stream_(stream) {
        for (auto& e : marks_) check(cudaEventCreate(&e));
    }
    cuda_times(const cuda_times&) = delete;
    cuda_times& operator=(const cuda_times&) = delete;
    ~cuda_times() {
        for (auto& e : marks_) cudaEventDestroy(e);
    }

    void sample(int every) {
        collect();
        sampling_ = every;
        iteration_ = 0;
        times_ = {};
    }
    void pause(bool paused) { paused_ = paused; }
    /// Returns whether the running iteration is timed.
    bool is_sampled() const { return iteration_ % sampling_ == 0; }

    void begin(stage s) {
        if (paused_) return;
        const auto i = static_cast<std::size_t>(s);
        if (in_range_) nvtxRangePop();
        in_range_ = s != stage::count;
        if (in_range_) nvtxRangePushA(stage_names[i]);
        if (!is_sampled()) return;
        check(cudaEventRecord(marks_[i], stream_));
        pending_[i] = true;
    }
    void end_iteration() {
        begin(stage::count);
        ++iteration_;
        if (is_sampled()) collect();
    }
    const stage_times& get() {
        collect();
        return times_;
    }

  private:
    /// Adds the times of the last timed iteration. Waits until it has ended.
    void collect() {
        std::size_t from = marks_.size();
        for (std::size_t s = 0; s < marks_.size(); ++s) {
            if (!pending_[s]) continue;
            if (from < marks_.size()) {
                float ms = 0;
                check(cudaEventSynchronize(marks_[s]));
                check(cudaEventElapsedTime(&ms, marks_[from], marks_[s]));
                times_.milliseconds[from] += ms;
            }
            from = s;
            pending_[s] = false;
        }
        if (from < marks_.size()) ++times_.sampled;
    }

    cudaStream_t stream_;
    std::array<cudaEvent_t, static_cast<std::size_t>(stage::count) + 1> marks_{};
    std::array<bool, static_cast<std::size_t>(stage::count) + 1> pending_{};
    stage_times times_;
    bool paused_ = false, in_range_ = false;
    int sampling_ = 50, iteration_ = 0;
};

}  // namespace gs::device
