// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// The kernels that have effects as a template parameter, for compare.py to compile: with g++ on the
// emulator's warps, with nvcc -x cu on those of a GPU.
#if defined(__CUDACC__)
#include <warpagg/warp/cuda.hpp>
#else
#include <warpagg/warp/simd.hpp>
#endif

#include "losses/l1_ssim/fused_l1_ssim.hpp"
#include "losses/l1_ssim/l1_ssim_kernels.hpp"
#include "optimize/adam.hpp"
#include "render/project/project.hpp"
#include "render/project/project_backward.hpp"

constexpr gs::effect_set effects{.antialiasing = EFFECTS,
                                 .lens = EFFECTS ? gs::lens_model::fisheye : gs::lens_model::pinhole,
                                 .depth = EFFECTS};
constexpr bool masked = EFFECTS;

#if defined(__CUDACC__)
using warp = warpagg::cuda_warp;

extern "C" __global__ void forward(gs::raster::project<warp, float, effects> kernel) {
    kernel(warp{}, blockIdx.x);
}
extern "C" __global__ void backward(
    gs::raster::project_backward<warp, float, gs::train::adam<float>, effects> kernel) {
    kernel(warp{}, blockIdx.x);
}
extern "C" __global__ void first_pass(gs::train::sum_and_difference<float, masked> kernel) {
    kernel(warp{}, blockIdx.x);
}
extern "C" __global__ void second_pass(gs::train::ssim_compare<float, masked> kernel) {
    kernel(warp{}, blockIdx.x);
}
extern "C" __global__ void last_pass(gs::train::l1_ssim_gradient<float, masked> kernel) {
    kernel(warp{}, blockIdx.x);
}
extern "C" __global__ void only_pass(gs::train::fused_l1_ssim<float, masked> kernel) {
    kernel(warp{}, blockIdx.x);
}
#else
using warp = warpagg::emulator::narrow_lanes<8>;

extern "C" void forward(const gs::raster::project<warp, float, effects>& kernel, unsigned index) {
    kernel(warp{}, index);
}
extern "C" void backward(
    const gs::raster::project_backward<warp, float, gs::train::adam<float>, effects>& kernel,
    unsigned index) {
    kernel(warp{}, index);
}
extern "C" void first_pass(const gs::train::sum_and_difference<float, masked>& kernel, unsigned index) {
    kernel(warp{}, index);
}
extern "C" void second_pass(const gs::train::ssim_compare<float, masked>& kernel, unsigned index) {
    kernel(warp{}, index);
}
extern "C" void last_pass(const gs::train::l1_ssim_gradient<float, masked>& kernel, unsigned index) {
    kernel(warp{}, index);
}
extern "C" void only_pass(const gs::train::fused_l1_ssim<float, masked>& kernel, unsigned index) {
    kernel(warpagg::emulator::lanes{}, index);
}
#endif
