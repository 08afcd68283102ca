// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "memory.hpp"

namespace gs::device {

/// Launches work as one CUDA graph. Later launches update the executable graph of earlier ones if
/// possible.
class cuda_graph {
  public:
    cuda_graph() = default;
    cuda_graph(const cuda_graph&) = delete;
    cuda_graph& operator=(const cuda_graph&) = delete;
    ~cuda_graph() {
        if (graph_ != nullptr) cudaGraphExecDestroy(graph_);
    }

    /// Captures the work that f submits to the stream, and launches it as a graph. f may launch
    /// kernels, copy and zero memory, but must not allocate or wait.
    template <class F>
    void launch(cudaStream_t stream, const F& f) {
        check(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal));
        cudaGraph_t captured = nullptr;
        try {
            f();
        } catch (...) {
            cudaStreamEndCapture(stream, &captured);
            cudaGraphDestroy(captured);
            throw;
        }
        check(cudaStreamEndCapture(stream, &captured));
        update(captured);
        cudaGraphDestroy(captured);
        check(cudaGraphLaunch(graph_, stream));
    }

  private:
    void update(cudaGraph_t to) {
        cudaGraphExecUpdateResultInfo info;
        if (graph_ != nullptr && cudaGraphExecUpdate(graph_, to, &info) == cudaSuccess) return;
        // This graph is the first, or has other launches than the previous one.
        cudaGetLastError();
        if (graph_ != nullptr) cudaGraphExecDestroy(graph_);
        check(cudaGraphInstantiate(&graph_, to, 0));
    }

    cudaGraphExec_t graph_ = nullptr;
};

}  // namespace gs::device
