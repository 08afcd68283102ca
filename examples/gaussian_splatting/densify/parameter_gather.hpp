// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <warpagg/core/compiler.hpp>

#include "../device/device.hpp"
#include "../model/aosoa.hpp"
#include "../model/gaussian_shares.hpp"
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

/// Makes each Gaussian its own origin. One index per Gaussian.
struct keep_gaussians {
    std::uint32_t* origin;
    birth* births;

    WARPAGG_HD void operator()(std::size_t i) const {
        origin[i] = static_cast<std::uint32_t>(i);
        births[i] = birth::kept;
    }
};

/// Gathers elements of an array of one parameter for the new generation, in whole blocks, from a piece of the
/// old array. Elements without an origin that has the parameter are zero. One index per new element.
template <class T>
struct gather_array {
    std::size_t count;   ///< number of new Gaussians with the parameter, which come first
    std::size_t before;  ///< number of old Gaussians with it, which come first
    const std::uint32_t* origin;
    const birth* births;
    std::size_t width;
    bool are_moments;
    std::size_t first;    ///< the new element of index 0
    ranks::share piece;   ///< old elements
    bool is_first_piece;  ///< writes zeros; other pieces leave elements with origins elsewhere
    const T* from;        ///< the piece
    T* to;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t at = first + i,
                          gaussian = at / (block_length * width) * block_length + at % block_length;
        const bool exists = gaussian < count && origin[gaussian] < before;
        const bool keeps = exists && (!are_moments || births[gaussian] == birth::kept ||
                                      births[gaussian] == birth::original);
        const std::size_t old = keeps ? aosoa_index(origin[gaussian], at / block_length % width, width) : 0;
        if (keeps && old >= piece.first && old < piece.last)
            to[i] = from[old - piece.first];
        else if (is_first_piece)
            to[i] = T{0};
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
    /// `shares` divides the new Gaussians among the ranks, and must exist as long as this object.
    /// `least_piece`: elements of an array that ranks gather at once; smaller pieces waste time.
    parameter_gather(Device& device, const gaussian_shares& shares,
                     std::size_t least_piece = std::size_t{1} << 22)
        : device_(device), shares_(shares), least_piece_(least_piece) {}

    /// Returns the size of the memory for each Gaussian of an SH degree, if this rank has a part of all.
    static std::size_t bytes_per_gaussian(int sh_degree, double part) {
        std::size_t widest = 0;
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (has_parameter(p, sh_degree))
                widest = std::max<std::size_t>(widest, width_of(static_cast<parameter>(p)));
        const std::size_t spare = std::max(static_cast<std::size_t>(part * static_cast<double>(widest)),
                                           width_of(parameter::quaternion)),
                          piece = part < 1 ? (widest + pieces - 1) / pieces : 0;
        return (spare + piece) * sizeof(float) + sizeof(birth) + 2 * sizeof(std::uint32_t);
    }

    /// Sets the capacity of `origins` and `births` to `most` new Gaussians. Both lose their
    /// contents.
    void reserve(std::size_t most) {
        origin_.resize(most);
        births_.resize(most);
    }
    /// Fills both arrays for a new generation of the same `count` Gaussians.
    void keep_all(std::size_t count) {
        reserve(count);
        device_.for_each_index(count, keep_gaussians{origins(), births()});
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
    /// origin has none. If ranks divide the Gaussians, all must call this, with the present state of all
    /// values that they do not divide. Does not wait for the device.
    void run(trained_parameters<Device>& all, std::size_t count, std::size_t with_sh, int sh_degree) {
        all.flush_cache(device_);
        const std::size_t with_sh_before = all.values.gaussians_with_sh();
        const ranks::shares among = shares_.of(count, device_.ranks().count());
        std::optional<ranks::share> own;
        if (all.shares) own = among.of(device_.ranks().rank());
        const auto gather_all = [&](auto& memory, bool are_moments) {
            for (std::size_t p = 0; p < parameter_count; ++p) {
                if (!has_parameter(p, sh_degree)) continue;
                const bool is_sh = is_view_dependent(p);
                gather(all, memory, p, is_sh ? with_sh : count,
                       is_sh ? with_sh_before : std::numeric_limits<std::size_t>::max(), are_moments, own);
            }
            memory.set_gaussians_with_sh(with_sh);
        };
        gather_all(all.values, false);
        all.for_each_moment([&](auto& moments) { gather_all(moments, true); });
        if (all.shares) all.set_shares(device_, among);
        spare_steps_.resize(count);
        device_.for_each_index(count,
                               gather_last_steps{origin_.data(), all.last_step.data(), spare_steps_.data()});
        all.last_step.resize(count);
        device_.copy(all.last_step.data(), spare_steps_.data(), count);
    }

    /// Frees all memory. Call it if another `run` is unlikely.
    void release() {
        origin_ = {};
        births_ = {};
        spare_steps_ = {};
        spare_ = {};
        spare_words_ = {};
        piece_ = {};
        piece_words_ = {};
    }

  private:
    template <class T, const auto& Widths>
    void gather(const trained_parameters<Device>& all, parameter_memory<Device, T, Widths>& memory,
                std::size_t p, std::size_t count, std::size_t before, bool are_moments,
                const std::optional<ranks::share>& own) {
        const std::size_t width = memory.width(p), elements = in_whole_blocks(count) * width;
        const ranks::share part = memory.part_of(p, elements, own);
        auto& spare = this->spare(T{});
        spare.resize(part.count());
        for_each_piece(all, memory, p, [&](const ranks::share& piece, const T* from) {
            device_.for_each_index(
                part.count(), gather_array<T>{count, before, origin_.data(), births(), width, are_moments,
                                              part.first, piece, piece.first == 0, from, spare.data()});
        });
        memory.replace(device_, p, elements, spare);
    }
    /// Calls f(piece, elements) for pieces of an array that together have all its elements, of all ranks.
    template <class T, const auto& Widths, class F>
    void for_each_piece(const trained_parameters<Device>& all, parameter_memory<Device, T, Widths>& memory,
                        std::size_t p, const F& f) {
        const std::size_t elements = memory.elements(p);
        if (!memory.is_divided(p)) return f(ranks::share{0, elements}, memory[p].data());
        const std::size_t block = block_length * memory.width(p),
                          length =
                              std::max<std::size_t>(elements / block / pieces, least_piece_ / block + 1) *
                              block;
        auto& copy = this->piece(T{});
        for (std::size_t first = 0; first == 0 || first < elements; first += length) {
            const ranks::share piece{first, std::min(first + length, elements)};
            copy.resize(piece.count());
            const ranks::shares of_ranks = all.shares->within(piece, block, elements);
            const ranks::share own = of_ranks.of(device_.ranks().rank());
            if (own.count() > 0)
                device_.copy(copy.data() + own.first,
                             memory[p].data() + (first + own.first - memory.part(p).first), own.count());
            const ranks::shared_array array[] = {ranks::shared_array::of(copy.data(), 1, copy.size())};
            device_.gather(of_ranks, array);
            f(piece, copy.data());
        }
    }
    buffer<float>& spare(float) { return spare_; }
    buffer<std::uint32_t>& spare(std::uint32_t) { return spare_words_; }
    buffer<float>& piece(float) { return piece_; }
    buffer<std::uint32_t>& piece(std::uint32_t) { return piece_words_; }

    /// The number of pieces of an array that is gathered from other ranks, unless it is small.
    static constexpr std::size_t pieces = 8;

    Device& device_;
    const gaussian_shares& shares_;
    std::size_t least_piece_;
    buffer<std::uint32_t> origin_;
    buffer<std::uint32_t> births_;  ///< each a `birth`
    buffer<float> spare_, piece_;   ///< for new elements, and for a piece of an array of floats
    buffer<std::uint32_t> spare_words_, piece_words_;
    buffer<std::uint32_t> spare_steps_;
};

}  // namespace gs::train
