// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// The snippets of ported kernels: none is diagnosed, and their sums are those of serial loops. All values
/// are small integers, so that sums are exact in any order.

#include "../snippets/ported_kernels.cu"
#include "../support/for_each_seed.hpp"
#include "scenes.hpp"

namespace {

constexpr unsigned gaussians = 3, pixels = 96, channels = 2, vertices = 5;

/// Whether a pixel shows a Gaussian. Gaussian 2 is in no pixel of the last warp.
__device__ bool shows(unsigned pixel, unsigned id) { return pixel % 3 != id && (id < 2 || pixel < 64); }

__global__ void add_gaussians(float* color, float3* mean, float4* conic, float* opacity) {
    const unsigned pixel = blockIdx.x * blockDim.x + threadIdx.x;
    for (unsigned id = 0; id < gaussians; ++id) {
        float values[9];
        for (unsigned i = 0; i < 9; ++i) values[i] = static_cast<float>(pixel % 4 + i + 10 * id);
        add_gaussian(color, mean, conic, opacity, id, values, shows(pixel, id));
    }
}

__global__ void add_all_channels(float* colors, float3* conic, float2* mean, float* opacity) {
    const unsigned pixel = blockIdx.x * blockDim.x + threadIdx.x;
    for (unsigned id = 0; id < gaussians; ++id) {
        if (warpagg::skip_if_warp_idle(warpagg::cuda_warp{}, shows(pixel, id))) continue;
        float values[channels + 6];
        for (unsigned i = 0; i < channels + 6; ++i) values[i] = static_cast<float>(pixel % 4 + i + 10 * id);
        add_channels<channels>(colors, conic, mean, opacity, id, values, shows(pixel, id));
    }
}

/// The sum of value i of a Gaussian over all pixels that show it.
float sum_over_pixels(unsigned id, unsigned i) {
    unsigned sum = 0;
    for (unsigned pixel = 0; pixel < pixels; ++pixel)
        if (shows(pixel, id)) sum += pixel % 4 + i + 10 * id;
    return static_cast<float>(sum);
}

constexpr int attributes = 4;

struct triangle {
    int vertex[3];
    float weight[3];
    float dy[attributes];
    bool covered;
};
__device__ triangle triangle_of(unsigned pixel) {
    const int first = static_cast<int>(pixel / 8 % 3);
    const auto x = static_cast<float>(pixel % 5);
    return {{first, first + 1, first + 2}, {1, 2, 3}, {x, 2 * x, 3 * x, 4 * x}, pixel % 7 != 0};
}

__global__ void interpolate(float* gradients) {
    const triangle t = triangle_of(blockIdx.x * blockDim.x + threadIdx.x);
    add_to_vertices(gradients, t.vertex, t.weight, t.dy, t.covered);
}
__global__ void interpolate_at_run_time(float* gradients, int count) {
    const triangle t = triangle_of(blockIdx.x * blockDim.x + threadIdx.x);
    add_to_vertices(gradients, t.vertex, t.weight, t.dy, count, t.covered);
}

__global__ void add_to_all_arrays(float* colors, float2* centers, float* radii) {
    const unsigned pixel = blockIdx.x * blockDim.x + threadIdx.x;
    const auto x = static_cast<float>(pixel);
    const float color[3] = {x, x + 1, x + 2}, center[2] = {x + 3, x + 4};
    add_to_arrays(colors, centers, radii, pixel * 7 % vertices, color, center, x + 5, pixel % 3 != 0);
}

}  // namespace

TEST_CASE("rows of several floats") {
    constexpr unsigned rows = 40, parts = 2, targets = 5;
    device_array<float4> values(rows * parts);
    device_array<unsigned> index(rows);
    std::vector<float> wanted(targets * parts * 4);
    for (unsigned i = 0; i < rows * parts; ++i) {
        const auto x = static_cast<float>(i);
        values[i] = make_float4(x, x + 1, x + 2, x + 3);
        index[i / parts] = i / parts * 7 % targets;
        for (unsigned k = 0; k < 4; ++k)
            wanted[(index[i / parts] * parts + i % parts) * 4 + k] += x + static_cast<float>(k);
    }
    for_each_seed(20, [&](std::uint64_t seed) {
        device_array<float> sums(targets * parts * 4, 0.0f);
        const cuda_grid grid{.blocks = 2, .threads = 64, .seed = seed};
        CHECK(try_launch(scatter_rows, grid, values, index, rows, parts, sums).text() == "");
        CHECK(std::vector<float>(sums.begin(), sums.end()) == wanted);
    });
}

TEST_CASE("segments of sorted values") {
    constexpr unsigned n = 50, segments = 4;
    device_array<float> values(n);
    device_array<long long> index(n);
    std::vector<float> wanted(segments);
    for (unsigned i = 0; i < n; ++i) {
        values[i] = static_cast<float>(i);
        index[i] = i / 15;
        wanted[i / 15] += values[i];
    }
    for_each_seed(20, [&](std::uint64_t seed) {
        device_array<float> sums{0, 0, 0, 0};
        const cuda_grid grid{.blocks = 1, .threads = 64, .seed = seed};
        CHECK(try_launch(sum_segments, grid, values, index, n, sums).text() == "");
        CHECK(std::vector<float>(sums.begin(), sums.end()) == wanted);
    });
}

TEST_CASE("gradients of Gaussians in four arrays") {
    for_each_seed(20, [&](std::uint64_t seed) {
        const cuda_grid grid{.blocks = 1, .threads = pixels, .seed = seed};
        device_array<float> color(3 * gaussians, 0.0f), opacity(gaussians, 0.0f);
        device_array<float3> mean(gaussians, float3{});
        device_array<float4> conic(gaussians, float4{});
        CHECK(try_launch(add_gaussians, grid, color, mean, conic, opacity).text() == "");
        for (unsigned id = 0; id < gaussians; ++id) {
            const float3 m = mean[id];
            const float4 c = conic[id];
            const float got[] = {color[3 * id], color[3 * id + 1], color[3 * id + 2], m.x, m.y, c.x, c.y,
                                 c.w,           opacity[id]};
            for (unsigned i = 0; i < 9; ++i) CHECK(got[i] == sum_over_pixels(id, i));
            CHECK(m.z == 0);
            CHECK(c.z == 0);
        }
    });
}

TEST_CASE("gradients of Gaussians with many channels") {
    for_each_seed(20, [&](std::uint64_t seed) {
        const cuda_grid grid{.blocks = 1, .threads = pixels, .seed = seed};
        device_array<float> colors(channels * gaussians, 0.0f), opacity(gaussians, 0.0f);
        device_array<float3> conic(gaussians, float3{});
        device_array<float2> mean(gaussians, float2{});
        CHECK(try_launch(add_all_channels, grid, colors, conic, mean, opacity).text() == "");
        for (unsigned id = 0; id < gaussians; ++id) {
            const float3 c = conic[id];
            const float2 m = mean[id];
            const float got[] = {colors[2 * id], colors[2 * id + 1], c.x, c.y, c.z, m.x, m.y, opacity[id]};
            for (unsigned i = 0; i < channels + 6; ++i) CHECK(got[i] == sum_over_pixels(id, i));
        }
    });
}

TEST_CASE("gradients of attributes at vertices") {
    std::vector<float> wanted(vertices * attributes);
    for (unsigned pixel = 0; pixel < pixels; ++pixel) {
        const triangle t = triangle_of(pixel);
        for (int corner = 0; t.covered && corner < 3; ++corner)
            for (int a = 0; a < attributes; ++a)
                wanted[static_cast<std::size_t>(t.vertex[corner] * attributes + a)] +=
                    t.weight[corner] * t.dy[a];
    }
    for_each_seed(20, [&](std::uint64_t seed) {
        const cuda_grid grid{.blocks = 1, .threads = pixels, .seed = seed};
        device_array<float> sums(vertices * attributes, 0.0f), at_run_time(vertices * attributes, 0.0f);
        CHECK(try_launch(interpolate, grid, sums).text() == "");
        CHECK(try_launch(interpolate_at_run_time, grid, at_run_time, attributes).text() == "");
        CHECK(std::vector<float>(sums.begin(), sums.end()) == wanted);
        CHECK(std::vector<float>(at_run_time.begin(), at_run_time.end()) == wanted);
    });
}

TEST_CASE("a loop that lanes leave at different times") {
    constexpr unsigned n = 50, items = 12;
    const device_array<float> prices{1, 2, 1, 3, 1, 2, 1, 3, 1, 2, 1, 3};
    device_array<float> money(n);
    std::vector<float> wanted(items);
    for (unsigned thread = 0; thread < n; ++thread) {
        money[thread] = static_cast<float>(thread % 32 < 4 ? 16 : thread % 7);
        float rest = money[thread];
        for (unsigned i = 0; i < items && prices[i] <= rest; ++i) {
            rest -= prices[i];
            ++wanted[i];
        }
    }
    for_each_seed(20, [&](std::uint64_t seed) {
        device_array<float> sold(items, 0.0f);
        const cuda_grid grid{.blocks = 1, .threads = 64, .seed = seed};
        CHECK(try_launch(sell, grid, prices, static_cast<int>(items), money, n, sold).text() == "");
        CHECK(std::vector<float>(sold.begin(), sold.end()) == wanted);
    });
}

TEST_CASE("several arrays by one comparison of keys") {
    std::vector<float> wanted(6 * vertices);
    for (unsigned pixel = 0; pixel < pixels; ++pixel)
        for (unsigned i = 0; pixel % 3 != 0 && i < 6; ++i)
            wanted[6 * (pixel * 7 % vertices) + i] += static_cast<float>(pixel + i);
    for_each_seed(20, [&](std::uint64_t seed) {
        device_array<float> colors(3 * vertices, 0.0f), radii(vertices, 0.0f);
        device_array<float2> centers(vertices, float2{});
        const cuda_grid grid{.blocks = 1, .threads = pixels, .seed = seed};
        CHECK(try_launch(add_to_all_arrays, grid, colors, centers, radii).text() == "");
        for (unsigned v = 0; v < vertices; ++v) {
            const float2 center = centers[v];
            const float got[] = {colors[3 * v], colors[3 * v + 1], colors[3 * v + 2],
                                 center.x,      center.y,          radii[v]};
            for (unsigned i = 0; i < 6; ++i) CHECK(got[i] == wanted[6 * v + i]);
        }
    });
}
