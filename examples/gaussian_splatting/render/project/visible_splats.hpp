// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../device/device.hpp"
#include "../geometry/splat.hpp"
#include "../tiles/tile_reach.hpp"
#include "project_backward.hpp"

namespace gs::raster {

/// Marks the Gaussians that are drawn. One index per Gaussian of a share.
struct mark_drawn {
    const std::uint32_t* tiles;  ///< of the share: see `project`
    std::uint32_t* marks;
    WARPAGG_HD void operator()(std::size_t i) const { marks[i] = tiles[i] != 0 ? 1 : 0; }
};

/// Copies the values of drawn Gaussians to consecutive places. One index per Gaussian of a share.
template <class T>
struct copy_drawn {
    const std::uint32_t* marks;
    const std::uint64_t* places;
    const T* from;
    T* to;
    WARPAGG_HD void operator()(std::size_t i) const {
        if (marks[i] != 0) to[places[i]] = from[i];
    }
};

/// Stores which Gaussian each place has. One index per Gaussian of a share.
struct number_drawn {
    const std::uint32_t* marks;
    const std::uint64_t* places;
    std::size_t first;
    std::uint32_t* gaussian_of;
    WARPAGG_HD void operator()(std::size_t i) const {
        if (marks[i] != 0) gaussian_of[places[i]] = static_cast<std::uint32_t>(first + i);
    }
};

/// Writes the numbers 0, 1, 2, ... One index per number.
struct count_up {
    std::uint32_t* numbers;
    WARPAGG_HD void operator()(std::size_t i) const { numbers[i] = static_cast<std::uint32_t>(i); }
};

/// Copies the sums of splats to the records of their Gaussians. One index per value.
template <class Real>
struct spread_sums {
    const std::uint32_t* gaussian_of;
    const Real* from;
    Real* to;
    WARPAGG_HD void operator()(std::size_t i) const {
        to[std::size_t{gaussian_of[i / record_stride]} * record_stride + i % record_stride] = from[i];
    }
};

/// The splats of a view that are drawn, in the order of their Gaussians, on each rank. A rank projects
/// only its own Gaussians, and gets the other splats from their owners.
template <device::device Device, class Real>
class visible_splats {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit visible_splats(Device& device) : device_(device) {}

    /// Collects the splats of all ranks. The arguments have a value per Gaussian; those of the share
    /// `own` are set. All ranks must call this. Waits for the device.
    void collect(const ranks::share& own, const splat<Real>* all_splats, const tile_box* all_boxes,
                 const std::uint32_t* all_depths, const std::uint32_t* all_tiles) {
        own_ = own;
        marks_.resize(own.count());
        places_.resize(own.count() + 1);
        device_.for_each_index(own.count(), mark_drawn{all_tiles + own.first, marks_.data()});
        device_.prefix_sum(marks_, places_, own.count());
        std::uint64_t drawn = 0;
        device_.download(&drawn, places_.data() + own.count(), 1);

        const int rank = device_.ranks().rank();
        std::vector<std::uint64_t> counts(static_cast<std::size_t>(device_.ranks().count()));
        counts[static_cast<std::size_t>(rank)] = drawn;
        device_.ranks().sum(counts.data(), counts.size());
        shares_ = ranks::shares(std::vector<std::size_t>(counts.begin(), counts.end()));
        gaussian_of_.resize(drawn);
        device_.for_each_index(own.count(),
                               number_drawn{marks_.data(), places_.data(), own.first, gaussian_of_.data()});
        copy(all_splats, splats);
        copy(all_boxes, boxes);
        copy(all_depths, depths);
        const ranks::shared_array arrays[] = {shared(splats), shared(boxes), shared(depths)};
        device_.gather(shares_, arrays);
        order.resize(count());
        device_.for_each_index(count(), count_up{order.data()});
    }
    /// Collects other splats of the same Gaussians. All ranks must call this.
    void collect(const splat<Real>* all_splats, buffer<splat<Real>>& to) {
        copy(all_splats, to);
        const ranks::shared_array arrays[] = {shared(to)};
        device_.gather(shares_, arrays);
    }
    /// Returns the sums of each Gaussian of this rank, from those of its splats. `gaussians`: the
    /// number of all Gaussians.
    const Real* by_gaussian(const Real* sums, std::size_t gaussians) {
        sums_.resize(gaussians * record_stride);
        const ranks::share own = shares_.of(device_.ranks().rank());
        device_.for_each_index(
            own.count() * record_stride,
            spread_sums<Real>{gaussian_of_.data(), sums + own.first * record_stride, sums_.data()});
        return sums_.data();
    }

    std::size_t count() const { return shares_.items(); }
    const ranks::shares& shares() const { return shares_; }

    /// The values of each splat: see `project`.
    buffer<splat<Real>> splats;
    buffer<tile_box> boxes;
    buffer<std::uint32_t> depths, order;

  private:
    template <class T>
    void copy(const T* from, buffer<T>& to) {
        to.resize(count());
        device_.for_each_index(own_.count(),
                               copy_drawn<T>{marks_.data(), places_.data(), from + own_.first,
                                             to.data() + shares_.of(device_.ranks().rank()).first});
    }
    template <class T>
    ranks::shared_array shared(const buffer<T>& values) const {
        return ranks::shared_array::of(values.data(), 1, count());
    }

    Device& device_;
    ranks::share own_;
    ranks::shares shares_{0, 1, 1};
    buffer<std::uint32_t> marks_, gaussian_of_;
    buffer<std::uint64_t> places_;
    buffer<Real> sums_;
};

}  // namespace gs::raster
