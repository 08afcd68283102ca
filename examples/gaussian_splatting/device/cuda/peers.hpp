// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstring>
#include <span>

#include "../../ranks/communicator.hpp"
#include "memory.hpp"
#include "nccl.hpp"

namespace gs::device {

/// The GPUs of all ranks, connected by NCCL. All functions are collective. They run in the order of the
/// stream, and don't wait. The connections last as long as the process, because NCCL ends them only
/// after all ranks of the machine have asked for it.
class cuda_peers {
  public:
    /// `all` counts the traffic, and must exist as long as this object.
    explicit cuda_peers(ranks::communicator& all)
        : rank_(all.rank()), count_(all.count()), traffic_(all.traffic()) {
        const ranks::traffic_counter::scope scope(traffic_, ranks::purpose::connection);
        ncclUniqueId id{};
        if (all.is_first()) nccl_.check(nccl_.unique_id(&id));
        std::array<std::uint64_t, sizeof(id) / sizeof(std::uint64_t)> words{};
        std::memcpy(words.data(), &id, sizeof(id));
        all.sum(words.data(), words.size());
        std::memcpy(&id, words.data(), sizeof(id));
        nccl_.check(nccl_.init_rank(&group_, count_, id, rank_));
        connect();
    }
    cuda_peers(const cuda_peers&) = delete;
    cuda_peers& operator=(const cuda_peers&) = delete;

    /// Gives all ranks the sums of n values. All ranks get the same bits.
    template <class T>
    void sum(T* values, std::size_t n, cudaStream_t stream) {
        traffic_.count_sum(n * sizeof(T));
        nccl_.check(nccl_.all_reduce(values, values, n, nccl_type<T>(), ncclSum, group_, stream));
    }
    /// Sends the windows of all arrays: see `ranks::communicator::exchange`.
    void exchange(const ranks::windows& windows, std::span<const ranks::window_array> arrays,
                  cudaStream_t stream) {
        traffic_.count_exchange(windows, arrays);
        for_each_other([&](int other) {
            for (const auto& array : arrays) {
                send(array.sent(windows, rank_, other), other, stream);
                receive(array.received(windows, other, rank_), other, stream);
            }
        });
    }
    /// Gives all ranks the parts of the others.
    void gather(const ranks::shares& shares, std::span<const ranks::shared_array> arrays,
                cudaStream_t stream) {
        traffic_.count_gather(shares, arrays);
        for_each_other([&](int other) {
            for (const auto& array : arrays) {
                send(array.part(shares, rank_), other, stream);
                receive(array.part(shares, other), other, stream);
            }
        });
    }

  private:
    /// Makes the first exchange, because NCCL connects GPUs when they first need it.
    void connect() {
        cuda_buffer<double> memory;
        memory.resize(static_cast<std::size_t>(count_));
        double* const values = memory.data();
        check(cudaMemsetAsync(values, 0, memory.size() * sizeof(double), cudaStreamLegacy));
        sum(values, static_cast<std::size_t>(count_), cudaStreamLegacy);
        const ranks::shared_array array[] = {
            ranks::shared_array::of(values, 1, static_cast<std::size_t>(count_))};
        gather({static_cast<std::size_t>(count_), 1, count_}, array, cudaStreamLegacy);
        check(cudaStreamSynchronize(cudaStreamLegacy));
    }
    /// Calls f for each other rank. The copies that it begins run together.
    template <class F>
    void for_each_other(const F& f) {
        nccl_.check(nccl_.group_start());
        for (int other = 0; other < count_; ++other)
            if (other != rank_) f(other);
        nccl_.check(nccl_.group_end());
    }
    void send(std::span<const std::byte> bytes, int rank, cudaStream_t stream) {
        if (!bytes.empty())
            nccl_.check(nccl_.send(bytes.data(), bytes.size(), ncclInt8, rank, group_, stream));
    }
    void receive(std::span<std::byte> bytes, int rank, cudaStream_t stream) {
        if (!bytes.empty())
            nccl_.check(nccl_.receive(bytes.data(), bytes.size(), ncclInt8, rank, group_, stream));
    }

    nccl nccl_;
    ncclComm_t group_ = nullptr;
    int rank_, count_;
    ranks::traffic_counter& traffic_;
};

}  // namespace gs::device
