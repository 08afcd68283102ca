// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <warpagg/core/compiler.hpp>

#include "../device/device.hpp"
#include "../model/aosoa.hpp"
#include "../model/parameters.hpp"
#include "../optimize/trained_parameters.hpp"

namespace gs::train {

/// The way in which a Gaussian of the new generation came from its origin. Copies and halves begin
/// with moments of zero; the others keep the moments of their origin.
enum class birth : std::uint32_t {
    kept,      ///< the only successor of its origin
    original,  ///< the origin itself, which also has a copy
    copy,
    half  ///< one half of a split
};

/// Clears the flags of the Gaussians with the first ranks. One index per rank.
struct clear_ranked {
    const std::uint32_t* gaussian_of;  ///< index of the Gaussian with a rank
    std::uint32_t* flags;

    WARPAGG_HD void operator()(std::size_t rank) const { flags[gaussian_of[rank]] = 0; }
};

/// Gathers an array of one parameter for the new generation, in whole blocks. One index per new element.
/// Elements are zero if the origin does not have the parameter.
template <class T>
struct gather_array {
    std::size_t count;   ///< number of new Gaussians with the parameter, which come first
    std::size_t before;  ///< number of old Gaussians with it, which come first
    const std::uint32_t* origin;
    const birth* births;
    std::size_t width;
    bool are_moments;
    const T* from;
    T* to;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t gaussian = i / (block_length * width) * block_length + i % block_length;
        const bool exists = gaussian < count && origin[gaussian] < before;
        const bool keeps = exists && (!are_moments || births[gaussian] == birth::kept ||
                                      births[gaussian] == birth::original);
        to[i] = keeps ? from[aosoa_index(origin[gaussian], i / block_length % width, width)] : T{0};
    }
};

/// Gives each new Gaussian the last step of its origin. One index per new Gaussian.
struct gather_last_steps {
    const std::uint32_t* origin;
    const std::uint32_t* from;
    std::uint32_t* to;

    WARPAGG_HD void operator()(std::size_t i) const { to[i] = from[origin[i]]; }
};

/// Moves all parameters of the Gaussians, with the state of Adam, to a new generation, which
/// reorders, removes or repeats Gaussians. Owns the memory for this.
template <device::device Device>
class parameter_gather {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit parameter_gather(Device& device) : device_(device) {}

    /// Returns the size of the memory for each Gaussian of an SH degree.
    static std::size_t bytes_per_gaussian(int sh_degree) {
        std::size_t widest = 0;
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (has_parameter(p, sh_degree))
                widest = std::max<std::size_t>(widest, width_of(static_cast<parameter>(p)));
        return widest * sizeof(float) + sizeof(birth) + 2 * sizeof(std::uint32_t);
    }

    /// Sets the capacity of `origins` and `births` to `most` new Gaussians. Both lose their
    /// contents.
    void reserve(std::size_t most) {
        origin_.resize(most);
        births_.resize(most);
    }
    /// Returns the array with the index of each new Gaussian's origin. Fill it before `run`.
    std::uint32_t* origins() const { return origin_.data(); }
    /// Returns the array with the birth of each new Gaussian. Fill it before `run`.
    birth* births() const { return reinterpret_cast<birth*>(births_.data()); }

    /// Orders the first `count` new Gaussians by their origins. Copies then lie beside each other, so that
    /// a warp has Gaussians which the same views show.
    void order_by_origin(std::size_t count) { device_.sort_pairs(origin_, births_, count); }

    /// Replaces the Gaussians with `count` new ones. The first `with_sh` of them, a multiple of the
    /// block length or all, have SH coefficients of degrees 1 to `sh_degree`, which are zero if the
    /// origin has none. Does not wait for the device.
    void run(trained_parameters<Device>& all, std::size_t count, std::size_t with_sh, int sh_degree) {
        all.flush_cache(device_);
        const std::size_t with_sh_before = all.values.gaussians_with_sh();
        const auto gather_all = [&](auto& memory, bool are_moments) {
            for (std::size_t p = 0; p < parameter_count; ++p)
                if (has_parameter(p, sh_degree))
                    gather(memory, p, is_view_dependent(p) ? with_sh : count,
                           is_view_dependent(p) ? with_sh_before : std::numeric_limits<std::size_t>::max(),
                           are_moments);
            memory.set_gaussians_with_sh(with_sh);
        };
        gather_all(all.values, false);
        all.for_each_moment([&](auto& moments) { gather_all(moments, true); });
        spare_steps_.resize(count);
        device_.for_each_index(count,
                               gather_last_steps{origin_.data(), all.last_step.data(), spare_steps_.data()});
        all.last_step.resize(count);
        device_.copy(all.last_step.data(), spare_steps_.data(), count);
    }

    /// Frees temporary memory. Call it if another `run` is unlikely.
    void release() {
        spare_ = {};
        spare_words_ = {};
    }

  private:
    template <class T, const auto& Widths>
    void gather(parameter_memory<Device, T, Widths>& memory, std::size_t p, std::size_t count,
                std::size_t before, bool are_moments) {
        buffer<T>& array = memory[p];
        const std::size_t width = memory.width(p), n = in_whole_blocks(count) * width;
        auto& spare = this->spare(T{});
        spare.resize(n);
        device_.for_each_index(n, gather_array<T>{count, before, origin_.data(), births(), width, are_moments,
                                                  array.data(), spare.data()});
        if (n < array.size()) memory.free(p);
        array.resize(n);
        device_.copy(array.data(), spare.data(), n);
    }
    buffer<float>& spare(float) { return spare_; }
    buffer<std::uint32_t>& spare(std::uint32_t) { return spare_words_; }

    Device& device_;
    buffer<std::uint32_t> origin_;
    buffer<std::uint32_t> births_;  ///< each a `birth`
    buffer<float> spare_;           ///< for an array of floats
    buffer<std::uint32_t> spare_words_;
    buffer<std::uint32_t> spare_steps_;
};

}  // namespace gs::train
