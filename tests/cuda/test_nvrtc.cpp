// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// The one include compiles at run time, by NVRTC, with nothing but its include path. No GPU is needed for
// that; where there is one, what was compiled also runs. The driver is loaded by name, so that this program
// starts without one.
#include <cuda.h>
#include <dlfcn.h>
#include <doctest/doctest.h>
#include <nvrtc.h>

#include <string>
#include <vector>

namespace {

constexpr const char* source = R"(
#include <warpagg/atomic.hpp>

extern "C" __global__ void sums(unsigned* record, unsigned n) {
    const warpagg::cuda_warp w;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const unsigned values[2] = {1, i};
    warpagg::warp_reduce_atomic(w, record, values, i < n);
    warpagg::warp_reduce_atomic(w, record + 2, values, i < n, warpagg::policy{warpagg::shfl_down});
}

extern "C" __global__ void sums_by_key(unsigned* records, unsigned n) {
    const warpagg::cuda_warp w;
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    const unsigned values[2] = {1, i};
    warpagg::warp_match_reduce_atomic(w, records, i % 2, values, i < n);
}

struct particle {
    float mass, momentum[2];
};
template <>
struct warpagg::aggregate_traits<particle> : warpagg::aggregate_of<float, 3> {};

extern "C" __global__ void the_rest(float* floats, long long* wide, unsigned* words, particle* particles, bool active) {
    using namespace warpagg;
    const cuda_warp w;
    __shared__ float copy[64];
    const stage<float> block(floats, copy, 64);
    block.clear(w, 0, 1);
    __syncthreads();
    const float nine[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    if (skip_if_warp_idle(w, active)) return;
    warp_reduce_atomic<float, 9>(w, floats, nine, active, policy{assume_busy, shfl_down, packed<4>});
    warp_reduce_atomic(w, block.record(5), nine, active, policy{staged, butterfly});
    __syncthreads();
    block.flush(w, 0, 1);
    warp_reduce_atomic(w, floats, nine, active, policy{maximum, block_scope});
    warp_reduce_atomic(w, fields(at<4>(floats), at<5>(floats + 8)), nine, active);
    const long long two[2] = {1, -1};
    warp_reduce_atomic(w, wide, two, active, policy{maximum, at_least<4>});
    const unsigned bits[1] = {w.lane()};
    warp_reduce_atomic(w, words, bits, active, policy{redux, bit_xor});
    warp_reduce_atomic(w, particles, particle{1, {2, 3}}, active);
}

template <class Accumulate>
__device__ void keep(void* cells, float* result, bool active, Accumulate how) {
    using namespace warpagg;
    const cuda_warp w;
    const float two[2] = {1, -1};
    auto* const to = static_cast<accumulator<Accumulate>*>(cells);
    warp_reduce_atomic(w, to, two, active, policy{how});
    warp_match_reduce_atomic(w, to, w.lane() % 2, two, active, policy{how});
    *result = to->value();
}

extern "C" __global__ void other_accumulators(void* cells, float* result, unsigned* fault, bool active) {
    namespace accumulate = warpagg::accumulate;
    keep(cells, result, active, accumulate::f64{});
    keep(cells, result, active, accumulate::compensated{});
    keep(cells, result, active, accumulate::fixed<9>{fault, accumulate::fixed<9>::scale_to_fit(3)});
    keep(cells, result, active, accumulate::binned<3>{});
    keep(cells, result, active, accumulate::exact{});
}
)";

/// The PTX of `source`, or an empty string and the compiler's log.
struct compiled {
    std::string ptx, log;

    explicit compiled(const char* architecture) {
        nvrtcProgram program{};
        REQUIRE(nvrtcCreateProgram(&program, source, "kernel.cu", 0, nullptr, nullptr) == NVRTC_SUCCESS);
        const char* options[] = {"-std=c++20", architecture, "-I" WARPAGG_INCLUDE_DIR};
        const bool good = nvrtcCompileProgram(program, 3, options) == NVRTC_SUCCESS;
        std::size_t size = 0;
        nvrtcGetProgramLogSize(program, &size);
        log.resize(size);
        nvrtcGetProgramLog(program, log.data());
        if (good && nvrtcGetPTXSize(program, &size) == NVRTC_SUCCESS) {
            ptx.resize(size);
            nvrtcGetPTX(program, ptx.data());
        }
        nvrtcDestroyProgram(&program);
    }
};

/// The driver's functions that this test calls.
class driver {
  public:
    decltype(&cuInit) init = nullptr;
    decltype(&cuDeviceGet) device = nullptr;
    decltype(&cuDeviceGetAttribute) attribute = nullptr;
    decltype(&cuDevicePrimaryCtxRetain) retain = nullptr;
    decltype(&cuCtxSetCurrent) set_current = nullptr;
    decltype(&cuModuleLoadData) load = nullptr;
    decltype(&cuModuleGetFunction) function = nullptr;
    decltype(&cuMemAlloc) allocate = nullptr;
    decltype(&cuMemsetD32) set = nullptr;
    decltype(&cuLaunchKernel) launch = nullptr;
    decltype(&cuMemcpyDtoH) download = nullptr;

    driver() : library_(dlopen("libcuda.so.1", RTLD_NOW)) {
        find(init, "cuInit");
        find(device, "cuDeviceGet");
        find(attribute, "cuDeviceGetAttribute");
        find(retain, "cuDevicePrimaryCtxRetain");
        find(set_current, "cuCtxSetCurrent");
        find(load, "cuModuleLoadData");
        find(function, "cuModuleGetFunction");
        find(allocate, "cuMemAlloc_v2");
        find(set, "cuMemsetD32_v2");
        find(launch, "cuLaunchKernel");
        find(download, "cuMemcpyDtoH_v2");
    }
    /// Returns whether a driver and a GPU exist that run PTX for compute_80.
    bool has_gpu() const {
        CUdevice first = 0;
        int major = 0;
        return library_ != nullptr && init(0) == CUDA_SUCCESS && device(&first, 0) == CUDA_SUCCESS &&
               attribute(&major, CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR, first) == CUDA_SUCCESS &&
               major >= 8;
    }
    /// What four words of zeros hold after `kernel(words, n)` on four warps.
    std::vector<unsigned> words_after(const std::string& ptx, const char* kernel, unsigned n) const {
        CUdevice first = 0;
        CUcontext context{};
        CUmodule module{};
        CUfunction entry{};
        CUdeviceptr words{};
        REQUIRE(device(&first, 0) == CUDA_SUCCESS);
        REQUIRE(retain(&context, first) == CUDA_SUCCESS);
        REQUIRE(set_current(context) == CUDA_SUCCESS);
        REQUIRE(load(&module, ptx.c_str()) == CUDA_SUCCESS);
        REQUIRE(function(&entry, module, kernel) == CUDA_SUCCESS);
        REQUIRE(allocate(&words, 4 * sizeof(unsigned)) == CUDA_SUCCESS);
        REQUIRE(set(words, 0, 4) == CUDA_SUCCESS);
        void* arguments[] = {&words, &n};
        REQUIRE(launch(entry, 2, 1, 1, 64, 1, 1, 0, nullptr, arguments, nullptr) == CUDA_SUCCESS);
        std::vector<unsigned> result(4);
        REQUIRE(download(result.data(), words, 4 * sizeof(unsigned)) == CUDA_SUCCESS);
        return result;
    }

  private:
    void* library_;

    template <class F>
    void find(F& f, const char* name) {
        if (library_ != nullptr) f = reinterpret_cast<F>(dlsym(library_, name));
    }
};

}  // namespace

TEST_CASE("NVRTC compiles the one include for sm_80 and sm_90") {
    for (const char* architecture : {"-arch=compute_80", "-arch=compute_90"}) {
        const compiled program(architecture);
        INFO(architecture, "\n", program.log);
        REQUIRE_FALSE(program.ptx.empty());
        CHECK(program.ptx.find("shfl.sync") != std::string::npos);
        CHECK(std::string(program.log.c_str()) == "");  // ends with a zero
    }
}

TEST_CASE("What NVRTC compiled adds up on the GPU") {
    const driver cuda;
    if (!cuda.has_gpu()) {
        MESSAGE("skipped: there is no GPU of compute capability 8.0 or later");
        return;
    }
    const compiled program("-arch=compute_80");
    constexpr unsigned n = 100, sum = n * (n - 1) / 2;
    CHECK(cuda.words_after(program.ptx, "sums", n) == std::vector<unsigned>{n, sum, n, sum});
    CHECK(cuda.words_after(program.ptx, "sums_by_key", n) ==
          std::vector<unsigned>{n / 2, sum / 2 - n / 4, n / 2, sum / 2 + n / 4});
}
