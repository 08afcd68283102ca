// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The functions of NCCL that the trainer uses. The library is loaded when they are needed, so that
/// neither building nor training on one GPU requires it.

#include <cuda_runtime.h>
#include <dlfcn.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "../../core/error.hpp"

namespace gs::device {

/// NCCL's interface, with the names and values of its header nccl.h.
/// @{
struct ncclComm;
using ncclComm_t = ncclComm*;
struct ncclUniqueId {
    char internal[128];
};
enum ncclResult_t : int { ncclSuccess = 0 };
enum ncclDataType_t : int { ncclInt8 = 0, ncclInt64 = 4, ncclUint64 = 5, ncclFloat32 = 7, ncclFloat64 = 8 };
enum ncclRedOp_t : int { ncclSum = 0 };
/// @}

template <class T>
constexpr ncclDataType_t nccl_type() {
    if constexpr (std::is_same_v<T, float>) return ncclFloat32;
    if constexpr (std::is_same_v<T, double>) return ncclFloat64;
    if constexpr (std::is_same_v<T, std::int64_t>) return ncclInt64;
    static_assert(std::is_floating_point_v<T> || (std::is_integral_v<T> && sizeof(T) == 8));
    return ncclUint64;
}

/// The loaded library. The constructor throws `error` if there is none, or if it is too old.
class nccl {
  public:
    nccl() {
        library_ = dlopen("libnccl.so.2", RTLD_NOW | RTLD_LOCAL);
        if (library_ == nullptr)
            throw error(
                "several GPUs need NCCL, but libnccl.so.2 was not found: install NVIDIA's package libnccl2, "
                "or add the folder of another copy to LD_LIBRARY_PATH");
        load(version, "ncclGetVersion");
        load(unique_id, "ncclGetUniqueId");
        load(init_rank, "ncclCommInitRank");
        load(all_reduce, "ncclAllReduce");
        load(send, "ncclSend");
        load(receive, "ncclRecv");
        load(group_start, "ncclGroupStart");
        load(group_end, "ncclGroupEnd");
        load(error_text, "ncclGetErrorString");
        constexpr int least = 21800;  // 2.18, the first for CUDA 12
        int found = 0;
        check(version(&found));
        if (found < least)
            throw error("several GPUs need NCCL 2.18 or newer, but libnccl.so.2 is NCCL " +
                        std::to_string(found / 10000) + "." + std::to_string(found / 100 % 100) +
                        ": update it");
    }
    nccl(const nccl&) = delete;
    nccl& operator=(const nccl&) = delete;

    void check(ncclResult_t status) const {
        if (status != ncclSuccess) throw std::runtime_error(std::string("NCCL: ") + error_text(status));
    }

    ncclResult_t (*version)(int*);
    ncclResult_t (*unique_id)(ncclUniqueId*);
    ncclResult_t (*init_rank)(ncclComm_t*, int ranks, ncclUniqueId, int rank);
    ncclResult_t (*all_reduce)(const void* from, void* to, std::size_t, ncclDataType_t, ncclRedOp_t,
                               ncclComm_t, cudaStream_t);
    ncclResult_t (*send)(const void*, std::size_t, ncclDataType_t, int rank, ncclComm_t, cudaStream_t);
    ncclResult_t (*receive)(void*, std::size_t, ncclDataType_t, int rank, ncclComm_t, cudaStream_t);
    ncclResult_t (*group_start)();
    ncclResult_t (*group_end)();
    const char* (*error_text)(ncclResult_t);

  private:
    template <class F>
    void load(F*& function, const char* name) {
        function = reinterpret_cast<F*>(dlsym(library_, name));
        if (function == nullptr)
            throw error(std::string("libnccl.so.2 has no function ") + name + ": update NCCL");
    }

    void* library_;
};

}  // namespace gs::device
