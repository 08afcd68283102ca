// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../device/device.hpp"
#include "../geometry/splat.hpp"
#include "../tiles/tile_reach.hpp"
#include "../tiles/view_strip.hpp"
#include "project_backward.hpp"

namespace gs::raster {

/// Marks the Gaussians of a share that each rank lists. One index per Gaussian.
struct mark_listed {
    listed_tile_rows rows;
    std::size_t count;           ///< number of Gaussians of the share
    const std::uint32_t* tiles;  ///< of the share, like the next: see `project`
    const tile_box* boxes;
    std::uint32_t* marks;  ///< `count` for each rank, and `count` more for the Gaussians that are drawn

    WARPAGG_HD void operator()(std::size_t i) const {
        const bool is_drawn = tiles[i] != 0;
        for (unsigned rank = 0; rank < rows.ranks; ++rank)
            marks[rank * count + i] = is_drawn && limited(boxes[i], rows.of[rank]).size() != 0 ? 1 : 0;
        marks[rows.ranks * count + i] = is_drawn ? 1 : 0;
    }
};

/// Counts the marks of each rank, and those after them. One index per number.
struct count_marks {
    const std::uint64_t* places;  ///< the prefix sum of the marks
    std::size_t count;            ///< marks of each rank
    std::uint64_t* counts;

    WARPAGG_HD void operator()(std::size_t rank) const {
        counts[rank] = places[(rank + 1) * count] - places[rank * count];
    }
};

/// The windows that a rank sends to all ranks, in places that follow each other.
struct sent_windows {
    const std::uint32_t* marks;   ///< see `mark_listed`
    const std::uint64_t* places;  ///< the prefix sum of the marks
    std::size_t count;            ///< number of Gaussians of the share
    unsigned own, ranks;
    std::uint64_t first_own;  ///< the first place of the window to the rank itself

    WARPAGG_HD bool is_drawn(std::size_t gaussian) const { return marks[ranks * count + gaussian] != 0; }
    /// Calls f(place) for each place of a Gaussian in windows to others, and g(item) with its number in the
    /// window to the rank itself, in the order of ranks.
    template <class F, class G>
    WARPAGG_HD void visit(std::size_t gaussian, const F& f, const G& g) const {
        for (unsigned rank = 0; rank < ranks; ++rank) {
            const std::size_t i = rank * count + gaussian;
            if (marks[i] == 0) continue;
            rank == own ? g(places[i] - first_own) : f(places[i]);
        }
    }
};

/// An array with a value per Gaussian, and the windows that receive them.
template <class T>
struct filled_array {
    const T* from;
    T* sent;
    T* kept;  ///< the window to the rank itself
};

/// Copies the values of each Gaussian to its places in windows. One index per Gaussian of a share.
template <class... T>
struct fill_windows : filled_array<T>... {
    sent_windows windows;

    WARPAGG_HD void operator()(std::size_t i) const {
        windows.visit(
            i, [&](std::uint64_t place) { ((filled_array<T>::sent[place] = filled_array<T>::from[i]), ...); },
            [&](std::uint64_t item) { ((filled_array<T>::kept[item] = filled_array<T>::from[i]), ...); });
    }
};

/// Writes the numbers 0, 1, 2, ... One index per number.
struct count_up {
    std::uint32_t* numbers;
    WARPAGG_HD void operator()(std::size_t i) const { numbers[i] = static_cast<std::uint32_t>(i); }
};

/// Adds the sums of each drawn Gaussian that the ranks have computed, in the order of ranks, so that the
/// result does not depend on the order in which they arrive. One index per Gaussian of a share.
/// `Round`: converts a T to a Real.
template <class T, class Real, class Round>
struct add_windows {
    sent_windows windows;
    const T* returned;  ///< sums in the places of windows to others
    const T* kept;      ///< those in the window to the rank itself
    Round round;
    Real* sums;  ///< of the share

    WARPAGG_HD void operator()(std::size_t i) const {
        if (!windows.is_drawn(i)) return;
        T total[record_stride];
        for (T& sum : total) sum = T(0);
        bool is_first = true;
        const auto add = [&](const T* part) {
            WARPAGG_UNROLL
            for (unsigned k = 0; k < record_stride; ++k) total[k] = is_first ? part[k] : total[k] + part[k];
            is_first = false;
        };
        windows.visit(
            i, [&](std::uint64_t place) { add(returned + place * record_stride); },
            [&](std::uint64_t item) { add(kept + item * record_stride); });
        WARPAGG_UNROLL
        for (unsigned k = 0; k < record_stride; ++k) sums[i * record_stride + k] = round(total[k]);
    }
};

/// The splats that a rank lists, in the order of their Gaussians. A rank projects only its own
/// Gaussians. It sends each splat to the ranks whose strips it may touch, and gets their sums back.
template <device::device Device, class Real>
class visible_splats {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit visible_splats(Device& device) : device_(device) {}

    /// Frees the memory, until the next `collect`.
    void release() {
        splats = {};
        boxes = {};
        depths = {};
        order = {};
        marks_ = {};
        places_ = {};
        exchanged_ = {};
        sent_boxes_ = {};
        sent_depths_ = {};
        sums_ = {};
    }

    /// Collects the splats of this rank's strip. The arrays have a value for each of the `own` Gaussians of
    /// this rank: see `project`. `rows`: the tile rows that each rank lists. All ranks must call this. Waits
    /// for the device.
    void collect(std::size_t own, const listed_tile_rows& rows, const splat<Real>* own_splats,
                 const tile_box* own_boxes, const std::uint32_t* own_depths, const std::uint32_t* own_tiles) {
        own_ = own;
        const std::size_t ranks = rows.ranks, marks = (ranks + 1) * own;
        marks_.resize(marks);
        places_.resize(marks + 1);
        device_.for_each_index(own, mark_listed{rows, own, own_tiles, own_boxes, marks_.data()});
        device_.prefix_sum(marks_, places_, marks);
        counts_.resize(ranks + 1);
        device_.for_each_index(ranks + 1, count_marks{places_.data(), own, counts_.data()});
        exchange_counts(ranks);

        device_.for_each_index(own, fill_windows<splat<Real>, tile_box, std::uint32_t>{
                                        filled(own_splats, exchanged<splat<Real>>(1), splats),
                                        filled(own_boxes, sent(sent_boxes_), boxes),
                                        filled(own_depths, sent(sent_depths_), depths), places()});
        order.resize(count());
        device_.for_each_index(count(), count_up{order.data()});
        const ranks::window_array arrays[] = {array(exchanged<splat<Real>>(1), splats),
                                              array(sent_boxes_.data(), boxes),
                                              array(sent_depths_.data(), depths)};
        device_.exchange(windows_, arrays);
    }
    /// Collects other splats of the same Gaussians. All ranks must call this.
    void collect(const splat<Real>* own_splats, buffer<splat<Real>>& to) {
        splat<Real>* const sent = exchanged<splat<Real>>(1);
        device_.for_each_index(own_, fill_windows<splat<Real>>{filled(own_splats, sent, to), places()});
        const ranks::window_array arrays[] = {array(sent, to)};
        device_.exchange(windows_, arrays);
    }
    /// Returns the sums of each drawn Gaussian of this rank, from those that all ranks have for the splats
    /// they list. Those of other Gaussians are unspecified. All ranks must call this.
    template <class T, class Round>
    const buffer<Real>& add_ranks(const T* of_listed, const Round& round) {
        T* const returned = exchanged<T>(record_stride);
        const ranks::window_array arrays[] = {ranks::window_array::of(of_listed, returned, record_stride)};
        device_.exchange(windows_.reversed(), arrays);
        sums_.resize(own_ * record_stride);
        device_.for_each_index(
            own_, add_windows<T, Real, Round>{places(), returned,
                                              of_listed + kept_in_received().first * record_stride, round,
                                              sums_.data()});
        return sums_;
    }

    /// The number of splats that this rank lists.
    std::size_t count() const { return windows_.received_by(rank()).items(); }
    /// The drawn splats of all ranks, by owner.
    const ranks::shares& drawn() const { return drawn_; }
    /// The number of splats that ranks have sent to others.
    std::size_t moved() const { return windows_.moved(); }

    /// The size of all arrays, with the gradient sums and boxes of the splats that this rank lists.
    std::size_t bytes() const {
        return splats.size() * bytes_per_listed_splat +
               sent_boxes_.size() * (sizeof(tile_box) + sizeof(std::uint32_t)) + exchanged_.size() +
               marks_.size() * sizeof(std::uint32_t) + places_.size() * sizeof(std::uint64_t);
    }
    static constexpr std::size_t bytes_per_listed_splat =
        sizeof(splat<Real>) + 2 * sizeof(tile_box) + 2 * sizeof(std::uint32_t) + record_stride * sizeof(Real);

    /// The values of each splat: see `project`.
    buffer<splat<Real>> splats;
    buffer<tile_box> boxes;
    buffer<std::uint32_t> depths, order;

  private:
    int rank() const { return device_.ranks().rank(); }
    /// Gives all ranks the numbers of splats in all windows. Waits for the device.
    void exchange_counts(std::size_t ranks) {
        counts_on_host_.resize(ranks + 1);
        device_.begin_download(counted_, counts_on_host_.data(), counts_.data(), ranks + 1);
        counted_.wait();
        std::vector<std::uint64_t> all(ranks * (ranks + 1));
        std::copy_n(
            counts_on_host_.data(), ranks + 1,
            all.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(rank()) * (ranks + 1)));
        device_.ranks().sum(all.data(), all.size());
        std::vector<std::size_t> windows, drawn;
        for (std::size_t i = 0; i < all.size(); ++i)
            (i % (ranks + 1) == ranks ? drawn : windows).push_back(all[i]);
        windows_ = ranks::windows(windows, static_cast<int>(ranks));
        drawn_ = ranks::shares(drawn);
    }
    ranks::share kept_in_sent() const { return windows_.sent_by(rank()).of(rank()); }
    ranks::share kept_in_received() const { return windows_.received_by(rank()).of(rank()); }
    sent_windows places() const {
        return {marks_.data(),
                places_.data(),
                own_,
                static_cast<unsigned>(rank()),
                static_cast<unsigned>(windows_.ranks()),
                kept_in_sent().first};
    }
    /// Reserves a value for each splat that this rank sends, or several values of memory that they share.
    /// @{
    template <class T>
    T* sent(buffer<T>& values) const {
        values.resize(windows_.sent_by(rank()).items());
        return values.data();
    }
    template <class T>
    T* exchanged(std::size_t values) {
        exchanged_.resize(windows_.sent_by(rank()).items() * values * sizeof(T));
        return reinterpret_cast<T*>(exchanged_.data());
    }
    /// @}
    template <class T>
    filled_array<T> filled(const T* from, T* to_others, buffer<T>& to) const {
        to.resize(count());
        return {from, to_others, to.data() + kept_in_received().first};
    }
    template <class T>
    static ranks::window_array array(const T* from, const buffer<T>& to) {
        return ranks::window_array::of(from, to.data(), 1);
    }

    Device& device_;
    std::size_t own_ = 0;  ///< number of this rank's Gaussians
    ranks::shares drawn_{0, 1, 1};
    ranks::windows windows_{std::vector<std::size_t>{0}, 1};
    buffer<std::uint32_t> marks_, sent_depths_;
    buffer<std::uint64_t> places_, counts_;
    typename Device::template host_buffer<std::uint64_t> counts_on_host_;
    typename Device::transfer counted_;
    buffer<tile_box> sent_boxes_;
    buffer<char> exchanged_;  ///< splats for other ranks, and later the sums that these send back
    buffer<Real> sums_;
};

}  // namespace gs::raster
