// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The emulator diagnoses wrong accesses of CUDA kernels to memory.

#include "../support/for_each_seed.hpp"
#include "scenes.hpp"

using warpagg::emulator::diagnosis;

namespace {

__global__ void read_one(const float* from, int i, float* to) { to[threadIdx.x] = from[i]; }
__global__ void copy_one(const float4* from, int i, float4* to) { to[threadIdx.x] = from[i]; }
__global__ void copy_bytes(const float* from, int n, float* to) {
    memcpy(to, from, static_cast<std::size_t>(n) * sizeof(float));
}

__device__ float table[4] = {1, 2, 3, 4};
__constant__ float constants[2] = {5, 6};
__global__ void read_variables(float* to) { to[0] = table[3] + constants[1]; }
__global__ void write_variable() { table[0] = 1; }

template <class T, int N>
__global__ void reverse_block(const T* from, T* to) {
    __shared__ T values[N];
    values[threadIdx.x] = from[blockIdx.x * N + threadIdx.x];
    __syncthreads();
    to[blockIdx.x * N + threadIdx.x] = values[N - 1 - threadIdx.x];
}
__global__ void reverse_without_barrier(float* to) {
    __shared__ float values[64];
    values[threadIdx.x] = 1;
    to[threadIdx.x] = values[63 - threadIdx.x];
}
/// Only the first block to run writes the shared variable.
__global__ void shared_of_one_block(int* blocks, int* to) {
    __shared__ int v;
    if (threadIdx.x == 0 && atomicAdd(blocks, 1) == 0) v = 7;
    __syncthreads();
    to[blockIdx.x * blockDim.x + threadIdx.x] = v;
}

extern __shared__ float dynamic[];
__global__ void fill_dynamic(int n, float* to) {
    for (int i = 0; i < n; ++i) dynamic[i] = 1;
    to[0] = dynamic[n - 1];
}

WARPAGG_DYNAMIC_SHARED(float, dynamic);

float3 third(float v) { return {v, v, v}; }
__global__ void struct_results(float3* to) {
    __shared__ float3 values[32];
    values[threadIdx.x] = third(static_cast<float>(threadIdx.x + 1));
    __syncthreads();
    to[threadIdx.x] = values[31 - threadIdx.x];
}

__global__ void write_undefined(int lanes, int* to) {
    if (static_cast<int>(threadIdx.x) >= lanes) return;
    const int v = __shfl_down_sync(0xffffffffu, 1, 1);
    to[threadIdx.x] = v;
}

__global__ void copy_from_undefined(int lanes, const int4* from, int4* to) {
    if (static_cast<int>(threadIdx.x) >= lanes) return;
    const int v = __shfl_down_sync(0xffffffffu, 1, 1);
    to[threadIdx.x] = from[v & 1];
}

__global__ void local_index(int i, float* to) {
    float local[3] = {1, 2, 3};
    to[0] = local[i];
}

}  // namespace

TEST_CASE("accesses in bounds and out of bounds") {
    const device_array<float> from{1, 2, 3};
    device_array<float> to(32);
    const auto read = [&](int i) { return try_launch(read_one, {}, from, i, to); };
    CHECK(read(2).text() == "");
    CHECK(to[31] == 3);
    CHECK(read(3).what == diagnosis::out_of_bounds);
    CHECK(read(3).sentence.find(" reads 4 bytes right after the end of an array of 12 bytes.") !=
          std::string::npos);
    CHECK(read(5).sentence.find(" 8 bytes after the end of an array") != std::string::npos);
    CHECK(read(-1).sentence.find(" 4 bytes before the start of an array") != std::string::npos);
    const float on_host[1] = {1};
    CHECK(try_launch(read_one, {}, on_host, 0, to).sentence.find(" that no device_array contains.") !=
          std::string::npos);
    CHECK(try_launch(copy_one, {}, device_array<float4>(1, float4{}), 1, device_array<float4>(32)).what ==
          diagnosis::out_of_bounds);
    CHECK(try_launch(copy_bytes, {.threads = 1}, from, 3, to).text() == "");
    CHECK(try_launch(copy_bytes, {.threads = 1}, from, 4, to).what == diagnosis::out_of_bounds);
}

TEST_CASE("an index out of bounds of an array of the thread") {
    device_array<float> to(1);
    CHECK(try_launch(local_index, {.threads = 1}, 2, to).text() == "");
    const report r = try_launch(local_index, {.threads = 1}, -1, to);
    CHECK(r.what == diagnosis::out_of_bounds);
    CHECK(r.sentence.find("Lane 0 uses the index -1 of an array of type 'float") == 0);
}

TEST_CASE("elements without values") {
    device_array<float> from(3), to(32);
    CHECK(try_launch(read_one, {}, from, 1, to).what == diagnosis::uninitialized_read);
    from[1] = 5;
    CHECK(try_launch(read_one, {}, from, 1, to).text() == "");
    CHECK(try_launch(read_one, {}, from, 2, to).what == diagnosis::uninitialized_read);
    CHECK(try_launch(read_one, {.threads = 1}, to, 31, from).text() == "");  // written by a kernel
    CHECK(try_launch(read_one, {.threads = 1}, from, 0, to).text() == "");
}

TEST_CASE("variables of the program") {
    device_array<float> to(1);
    CHECK(try_launch(read_variables, {.threads = 1}, to).text() == "");
    CHECK(to[0] == 10);
    CHECK(try_launch(write_variable, {.threads = 1}).text() == "");
    CHECK(try_launch(write_variable, {.threads = 2}).what == diagnosis::data_race);
}

TEST_CASE("shared memory belongs to a block") {
    std::vector<double> numbers(256);
    for (unsigned i = 0; i < 256; ++i) numbers[i] = i;
    const device_array<double> from(numbers);
    device_array<double> to(256);
    for_each_seed(20, [&](std::uint64_t seed) {
        const report r =
            try_launch(reverse_block<double, 64>, {.blocks = 4, .threads = 64, .seed = seed}, from, to);
        CHECK(r.text() == "");
        for (unsigned i = 0; i < 256; ++i) CHECK(to[i] == numbers[i / 64 * 64 + 63 - i % 64]);
        device_array<int> order{0}, values(64);
        CHECK(try_launch(shared_of_one_block, {.blocks = 2, .seed = seed}, order, values).what ==
              diagnosis::uninitialized_read);
    });
}

TEST_CASE("a read before the write of another thread is a race in every schedule") {
    device_array<float> to(64);
    for_each_seed(200, [&](std::uint64_t seed) {
        CHECK(try_launch(reverse_without_barrier, {.threads = 64, .seed = seed}, to).what ==
              diagnosis::data_race);
    });
}

TEST_CASE("dynamic shared memory has the size of the launch") {
    device_array<float> to(1);
    CHECK(try_launch(fill_dynamic, {.threads = 1, .shared_bytes = 400}, 100, to).text() == "");
    const report r = try_launch(fill_dynamic, {.threads = 1, .shared_bytes = 400}, 101, to);
    CHECK(r.what == diagnosis::out_of_bounds);
    CHECK(r.sentence ==
          "Lane 0 writes 4 bytes right after the end of the dynamic shared memory of 400 bytes.");
    CHECK(try_launch(fill_dynamic, {.threads = 1}, 1, to).what == diagnosis::out_of_bounds);
}

TEST_CASE("structs that functions return") {
    device_array<float3> to(32);
    for_each_seed(20, [&](std::uint64_t seed) {
        CHECK(try_launch(struct_results, {.seed = seed}, to).text() == "");
        CHECK(to[0].z == 32);
    });
}

TEST_CASE("undefined integers must not reach memory by plain writes") {
    const device_array<int4> from{{1, 2, 3, 4}, {5, 6, 7, 8}};
    device_array<int4> structs(32);
    device_array<int> to(32);
    for_each_seed(20, [&](std::uint64_t seed) {
        CHECK(try_launch(write_undefined, {.seed = seed}, 32, to).text() == "");
        CHECK(try_launch(write_undefined, {.seed = seed}, 20, to).what == diagnosis::inactive_lane_read);
        CHECK(try_launch(copy_from_undefined, {.seed = seed}, 32, from, structs).text() == "");
        CHECK(try_launch(copy_from_undefined, {.seed = seed}, 20, from, structs).what ==
              diagnosis::inactive_lane_read);
    });
}
