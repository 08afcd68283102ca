// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "../../core/error.hpp"
#include "../../device/device.hpp"
#include "../project/depth_splats.hpp"
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

/// Returns the float of a sum in fixed point.
template <class Accumulate>
struct round_fixed {
    float unit;

    WARPAGG_HD float operator()(std::int64_t sum) const {
        return warpagg::accumulator<Accumulate>{{sum}}.value() * unit;
    }
};

/// Returns a sum as it is.
struct keep_sum {
    template <class Real>
    WARPAGG_HD Real operator()(Real sum) const {
        return sum;
    }
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
    /// Called after the kernel. Returns the sums as `Real`.
    template <class Kernel>
    const buffer<Real>& end(const Kernel& kernel) {
        if constexpr (!are_real<Kernel>)
            device_.for_each_index(sums_.size(),
                                   round_sums<kept_by<Kernel>>{kernel.sums, unit_of(kernel), sums_.data()});
        return sums_;
    }
    /// Called after the kernel if each rank has sums for its `own` Gaussians and, behind them, for the splats
    /// of others. Returns the sums of all ranks for its own Gaussians: see `splat_exchange::add_ranks`.
    /// Precondition: the sums are `Real` or in fixed point.
    template <class Kernel, class Exchange>
    const buffer<Real>& end_for_owners(const Kernel& kernel, Exchange& exchange, std::size_t own) {
        const std::size_t others = own * record_stride;
        if constexpr (are_real<Kernel>)
            exchange.add_ranks(sums_.data(), sums_.data() + others, keep_sum{}, sums_.data());
        else if constexpr (are_fixed<Kernel>)
            exchange.add_ranks(fixed(), fixed() + others, round_fixed<kept_by<Kernel>>{unit_of(kernel)},
                               sums_.data());
        else
            throw error("ranks cannot add the sums of this accumulator");
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
    template <class Kernel>
    using kept_by = typename Kernel::policy::accumulate::storage;
    template <class Kernel>
    static constexpr bool are_real =
        std::is_same_v<std::remove_pointer_t<decltype(std::declval<Kernel>().sums)>, Real>;
    template <class Kernel>
    static constexpr bool are_fixed = requires(const Kernel kernel) {
        kernel.how.accumulating().fault;
    };
    /// Returns the value of one unit of an accumulator.
    template <class Kernel>
    static float unit_of(const Kernel& kernel) {
        if constexpr (requires { kernel.how.accumulating().scale; })
            return 1 / kernel.how.accumulating().scale;
        else
            return 1;
    }
    std::int64_t* fixed() const { return reinterpret_cast<std::int64_t*>(cells_.data()); }

    Device& device_;
    buffer<Real> sums_;
    buffer<std::uint64_t> cells_;
    buffer<std::uint32_t> fault_;
};

}  // namespace gs::raster
