// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include "../../core/error.hpp"
#include "../../device/device.hpp"
#include "../blend/depth_splats.hpp"
#include "accumulator_set.hpp"

namespace gs::raster {

/// Rounds accumulated sums to floats. One index per sum.
template <class Accumulate>
struct round_sums {
    const warpagg::accumulator<Accumulate>* cells;
    float unit;  ///< value of one unit of an accumulator
    float* sums;

    WARPAGG_HD void operator()(std::size_t i) const { sums[i] = cells[i].value() * unit; }
};

/// The gradient sums of a backward pass, and their memory on the device.
template <device::device Device, class Real>
class gradient_sums {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    /// The largest sum of a warp in fixed point, relative to the largest gradient of a pixel. A
    /// warp has 64 pixels, moments of up to 8, and differences of colors, most of which are below
    /// 1.
    static constexpr float headroom = 4096;

    explicit gradient_sums(Device& device) : device_(device) {
        fault_.resize(1);
        device_.zero(fault_.data(), 1);
    }

    /// Clears the sums of all Gaussians and passes them to the kernel, a `blend_backward`. If it
    /// `goes_on`, the kernel continues with the sums that `set_depths_aside` has kept. `largest`:
    /// the approximate magnitude of a pixel's gradient; fixed point leaves out sums above
    /// `headroom` times this value. `warps`: the largest number of warps that add to a sum. Throws
    /// `error` if there are too many for fixed point.
    template <class Kernel>
    void begin(Kernel& kernel, std::size_t gaussians, float largest, std::size_t warps,
               bool goes_on = false) {
        using in_memory = std::remove_pointer_t<decltype(kernel.sums)>;
        const std::size_t n = gaussians * record_stride;
        sums_.resize(n);
        if constexpr (std::is_same_v<in_memory, Real>) {
            kernel.sums = sums_.data();
            if (!goes_on) device_.zero(sums_.data(), n);
        } else {
            static_assert(sizeof(in_memory) % sizeof(std::uint64_t) == 0);
            const std::size_t words = n * (sizeof(in_memory) / sizeof(std::uint64_t));
            cells_.resize(words);
            if (!goes_on) device_.zero(cells_.data(), words);
            kernel.sums = reinterpret_cast<in_memory*>(cells_.data());
        }
        if constexpr (requires { kernel.how.accumulating().fault; }) {
            if (warps > std::size_t{1} << fixed_log_warps)
                throw error("sums in fixed point are of up to 2^" + std::to_string(fixed_log_warps) +
                            " patches, and an image has " + std::to_string(warps) +
                            ": lower --resolution, or train without --deterministic");
            kernel.how = typename Kernel::policy(
                {}, {}, {fixed_sums{fault_.data(), fixed_sums::scale_to_fit(headroom * largest)}});
        }
    }
    /// Called instead of `end` after a kernel that blended `depth_splats`: keeps the sums for the
    /// next kernel.
    template <class Kernel>
    void set_depths_aside(const Kernel& kernel) {
        using in_memory = std::remove_pointer_t<decltype(kernel.sums)>;
        device_.for_each_index(sums_.size() / record_stride, set_red_aside<in_memory>{kernel.sums});
    }
    /// Called after the kernel. Returns the sums as `Real`. If `adds_ranks`, first adds those of all ranks.
    /// With `owners`, a rank gets the sums of its own share of the Gaussians only.
    template <class Kernel>
    const buffer<Real>& end(const Kernel& kernel, bool adds_ranks, const ranks::shares* owners) {
        if constexpr (std::is_same_v<std::remove_pointer_t<decltype(kernel.sums)>, Real>) {
            if (adds_ranks) add_ranks(sums_.data(), owners);
        } else {
            if constexpr (requires { kernel.how.accumulating().fault; })
                if (adds_ranks) add_ranks(reinterpret_cast<std::int64_t*>(cells_.data()), owners);
            float unit = 1;
            if constexpr (requires { kernel.how.accumulating().scale; })
                unit = 1 / kernel.how.accumulating().scale;
            const std::size_t n = sums_.size();
            device_.for_each_index(
                owners == nullptr ? ranks::share{0, n} : owners->of(device_.ranks().rank(), record_stride, n),
                round_sums<kept_by<Kernel>>{kernel.sums, unit, sums_.data()});
        }
        return sums_;
    }

    /// Returns the size of the sums of a Gaussian. Accumulators other than `native` have an integer
    /// of 64 bits for each sum.
    static constexpr std::size_t bytes_per_gaussian(accumulator how) {
        return record_stride * (sizeof(Real) + (how == accumulator::native ? 0 : sizeof(std::uint64_t)));
    }

    /// A flag on the device: not zero after a sum did not fit into fixed point and was left out.
    std::uint32_t* fault() const { return fault_.data(); }

  private:
    /// Precondition: there is one value per sum.
    template <class T>
    void add_ranks(T* values, const ranks::shares* owners) {
        using enum ranks::purpose;
        const ranks::traffic_counter::scope scope(device_.ranks().traffic(),
                                                  owners == nullptr ? scores : gradients);
        owners == nullptr ? device_.sum_over_ranks(values, sums_.size())
                          : device_.sum_for_owners(*owners, values, record_stride, sums_.size());
    }

    template <class Kernel>
    using kept_by = typename Kernel::policy::accumulate::storage;

    Device& device_;
    buffer<Real> sums_;
    buffer<std::uint64_t> cells_;
    buffer<std::uint32_t> fault_;
};

}  // namespace gs::raster
