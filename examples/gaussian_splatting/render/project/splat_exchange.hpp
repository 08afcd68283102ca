// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "../../device/device.hpp"
#include "../geometry/splat.hpp"
#include "../tiles/strip_splats.hpp"
#include "../tiles/tile_reach.hpp"
#include "../tiles/view_strip.hpp"
#include "project_backward.hpp"

namespace gs::raster {

/// Marks the Gaussians of a share that each other rank lists. One index per Gaussian.
struct mark_listed {
    listed_tile_rows rows;
    unsigned own;                ///< this rank
    std::size_t count;           ///< number of Gaussians of the share
    const std::uint32_t* tiles;  ///< of the share, like the next: see `project`
    const tile_box* boxes;
    std::uint32_t* marks;  ///< `count` for each rank, and `count` more for the Gaussians that are drawn

    WARPAGG_HD void operator()(std::size_t i) const {
        const bool is_drawn = tiles[i] != 0;
        for (unsigned rank = 0; rank < rows.ranks; ++rank) {
            const bool is_sent = is_drawn && rank != own && limited(boxes[i], rows.of[rank]).size() != 0;
            marks[rank * count + i] = is_sent ? 1 : 0;
        }
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

/// The windows that a rank sends to the others, in places that follow each other.
struct sent_windows {
    const std::uint32_t* marks;   ///< see `mark_listed`
    const std::uint64_t* places;  ///< the prefix sum of the marks
    std::size_t count;            ///< number of Gaussians of the share
    unsigned own, ranks;
    std::uint64_t first[ranks::most_ranks + 1];  ///< the first place of each window, and the end of the last

    WARPAGG_HD bool is_drawn(std::size_t gaussian) const { return marks[ranks * count + gaussian] != 0; }
    /// Whether a Gaussian has this place.
    WARPAGG_HD bool is_taken(std::size_t place) const {
        unsigned rank = 0;
        while (place >= first[rank + 1]) ++rank;
        const std::uint64_t* const begin = places + rank * count;
        return place - first[rank] < begin[count] - begin[0];
    }
    /// Calls f(place) for each place of a Gaussian, in the order of ranks, and g() when this rank's turn
    /// comes. Leaves out windows without a place for it.
    template <class F, class G>
    WARPAGG_HD void visit(std::size_t gaussian, const F& f, const G& g) const {
        for (unsigned rank = 0; rank < ranks; ++rank) {
            if (rank == own) g();
            const std::size_t i = rank * count + gaussian;
            if (marks[i] == 0) continue;
            const std::uint64_t place = first[rank] + places[i] - places[rank * count];
            if (place < first[rank + 1]) f(place);
        }
    }
};

/// Writes the Gaussian of each place. One index per Gaussian of a share.
struct index_windows {
    sent_windows windows;
    std::uint32_t* gaussians;

    WARPAGG_HD void operator()(std::size_t i) const {
        windows.visit(
            i, [&](std::uint64_t place) { gaussians[place] = static_cast<std::uint32_t>(i); }, [] {});
    }
};

/// Copies splats to their places in windows, and what `splat_reach` has, unless there is no memory for it.
/// Places that no Gaussian has taken get an empty box. One index per place.
template <class Real>
struct fill_windows {
    sent_windows windows;
    const std::uint32_t* gaussians;  ///< of each place
    const splat<Real>* splats;       ///< of the share, like the next two
    const tile_box* boxes;
    const std::uint32_t* depths;
    splat<Real>* sent;
    splat_reach* sent_reach;

    WARPAGG_HD void operator()(std::size_t place) const {
        if (!windows.is_taken(place)) {
            if (sent_reach != nullptr) sent_reach[place] = {};
            return;
        }
        const std::uint32_t gaussian = gaussians[place];
        sent[place] = splats[gaussian];
        if (sent_reach != nullptr) sent_reach[place] = {boxes[gaussian], depths[gaussian]};
    }
};

/// Adds the sums that other ranks have returned to those of this rank, in the order of ranks, so that the
/// result does not depend on the order in which they arrive. One index per Gaussian of a share. `Round`:
/// converts a T to a Real.
template <class T, class Real, class Round>
struct add_windows {
    sent_windows windows;
    const T* returned;  ///< in the places of windows
    const T* own;       ///< of the share, like the next; they may be the same array
    Real* sums;
    Round round;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (!windows.is_drawn(i)) return;
        T total[record_stride];
        for (T& sum : total) sum = T(0);
        bool is_first = true, is_sent = false;
        const auto add = [&](const T* part) {
            WARPAGG_UNROLL
            for (unsigned k = 0; k < record_stride; ++k) total[k] = is_first ? part[k] : total[k] + part[k];
            is_first = false;
        };
        windows.visit(
            i,
            [&](std::uint64_t place) {
                add(returned + place * record_stride);
                is_sent = true;
            },
            [&] { add(own + i * record_stride); });
        if (std::is_same_v<T, Real> && !is_sent) return;
        WARPAGG_UNROLL
        for (unsigned k = 0; k < record_stride; ++k) sums[i * record_stride + k] = round(total[k]);
    }
};

/// The splats that ranks send each other. A rank projects only its own Gaussians. It sends each splat to the
/// other ranks whose strips it may touch, and gets their sums back. Received splats are in windows, one for
/// each sender. Places that are not used have empty boxes.
template <device::device Device, class Real>
class splat_exchange {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit splat_exchange(Device& device) : device_(device) {}

    /// Frees the memory, until the next exchange.
    void release() {
        marks_ = {};
        places_ = {};
        sent_ = {};
        gaussians_ = {};
        sent_reach_ = {};
        received_reach_ = {};
        received_ = 0;
    }

    /// Counts the splats that other ranks list. `rows`: the tile rows that each rank lists. The arrays have
    /// a value for each of the `own` Gaussians of this rank: see `project`. `expected`: windows that probably
    /// have places for all splats, equal in all ranks. `fits` must be called later. Without them, waits for
    /// the device to learn the numbers of splats. All ranks must call this.
    void begin(std::size_t own, const listed_tile_rows& rows, const tile_box* own_boxes,
               const std::uint32_t* own_tiles, const std::optional<ranks::windows>& expected) {
        own_ = own;
        const std::size_t ranks = rows.ranks, marks = (ranks + 1) * own;
        marks_.resize(marks);
        places_.resize(marks + 1);
        device_.for_each_index(
            own, mark_listed{rows, static_cast<unsigned>(rank()), own, own_tiles, own_boxes, marks_.data()});
        device_.prefix_sum(marks_, places_, marks);
        counts_.resize(ranks + 1);
        device_.for_each_index(ranks + 1, count_marks{places_.data(), own, counts_.data()});
        counts_on_host_.resize(ranks + 1);
        device_.begin_download(counted_, counts_on_host_.data(), counts_.data(), ranks + 1);
        if (!expected) exchange_counts(ranks);
        windows_ = expected ? *expected : numbers();
        received_ = windows_.received_by(rank()).items();
    }
    /// Sends the splats. `received`: memory for those of others. All ranks must call this after `begin`.
    void send(const splat<Real>* own_splats, const tile_box* own_boxes, const std::uint32_t* own_depths,
              splat<Real>* received) {
        const std::size_t sent = windows_.sent_by(rank()).items();
        gaussians_.resize(sent);
        sent_reach_.resize(sent);
        received_reach_.resize(received_);
        device_.for_each_index(own_, index_windows{places(), gaussians_.data()});
        fill(own_splats, own_boxes, own_depths, sent_reach_.data());
        const ranks::window_array arrays[] = {
            ranks::window_array::of(sent_as<splat<Real>>(1), received, 1),
            ranks::window_array::of(sent_reach_.data(), received_reach_.data(), 1)};
        device_.exchange(windows_, arrays);
    }
    /// Returns whether all splats have places in the expected windows. If not, `begin` and `send` must be
    /// called again, without them. Waits until the device has counted the splats, but not for later work,
    /// so that it stays busy. All ranks must call this.
    bool fits() {
        exchange_counts(static_cast<std::size_t>(windows_.ranks()));
        return windows_.have_places_for(numbers());
    }
    /// Sends other splats of the same Gaussians. All ranks must call this.
    void send_again(const splat<Real>* own_splats, splat<Real>* received) {
        fill(own_splats, nullptr, nullptr, nullptr);
        const ranks::window_array arrays[] = {ranks::window_array::of(sent_as<splat<Real>>(1), received, 1)};
        device_.exchange(windows_, arrays);
    }
    /// Sends sums back, and adds those of all ranks. `own` and `received` are the sums that this rank has for
    /// its own Gaussians, and for the received splats. `sums` receives those of its drawn Gaussians. It may
    /// be `own`. All ranks must call this.
    template <class T, class Round>
    void add_ranks(const T* own, const T* received, const Round& round, Real* sums) {
        T* const returned = sent_as<T>(record_stride);
        const ranks::window_array arrays[] = {ranks::window_array::of(received, returned, record_stride)};
        device_.exchange(windows_.reversed(), arrays);
        device_.for_each_index(own_, add_windows<T, Real, Round>{places(), returned, own, sums, round});
    }

    /// The boxes and depths of splats from others, and the number of these with unused places.
    /// @{
    const splat_reach* received_reach() const { return received_reach_.data(); }
    std::size_t received() const { return received_; }
    /// @}
    /// The number of places for splats from earlier ranks.
    std::size_t received_before() const { return windows_.received_by(rank()).of(rank()).first; }
    /// The drawn splats of all ranks, by owner.
    const ranks::shares& drawn() const { return drawn_; }
    /// The number of splats in each window: see `ranks::windows`.
    const std::vector<std::size_t>& window_counts() const { return window_counts_; }
    /// The number of places for splats that ranks have sent to others.
    std::size_t moved() const { return windows_.moved(); }
    /// The size of all arrays.
    std::size_t bytes() const {
        return (marks_.size() + gaussians_.size()) * sizeof(std::uint32_t) +
               places_.size() * sizeof(std::uint64_t) + sent_.size() +
               (sent_reach_.size() + received_reach_.size()) * sizeof(splat_reach);
    }

  private:
    int rank() const { return device_.ranks().rank(); }
    /// Gives all ranks the numbers of splats in all windows. Waits until the device has counted them.
    void exchange_counts(std::size_t ranks) {
        counted_.wait();
        std::vector<std::uint64_t> all(ranks * (ranks + 1));
        std::copy_n(
            counts_on_host_.data(), ranks + 1,
            all.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(rank()) * (ranks + 1)));
        device_.ranks().sum(all.data(), all.size());
        window_counts_.clear();
        std::vector<std::size_t> drawn;
        for (std::size_t i = 0; i < all.size(); ++i)
            (i % (ranks + 1) == ranks ? drawn : window_counts_).push_back(all[i]);
        drawn_ = ranks::shares(drawn);
    }
    /// Returns windows with a place for each splat.
    ranks::windows numbers() const { return {window_counts_, drawn_.ranks()}; }
    sent_windows places() const {
        sent_windows all{marks_.data(), places_.data(), own_, static_cast<unsigned>(rank()), 0, {}};
        for (; all.ranks < static_cast<unsigned>(windows_.ranks()); ++all.ranks) {
            const ranks::share window = windows_.sent_by(rank()).of(static_cast<int>(all.ranks));
            all.first[all.ranks] = window.first;
            all.first[all.ranks + 1] = window.last;
        }
        return all;
    }
    /// Fills the windows that this rank sends.
    void fill(const splat<Real>* splats, const tile_box* boxes, const std::uint32_t* depths,
              splat_reach* reach) {
        const sent_windows to = places();
        device_.for_each_index(
            windows_.sent_by(rank()).items(),
            fill_windows<Real>{to, gaussians_.data(), splats, boxes, depths, sent_as<splat<Real>>(1), reach});
    }
    /// Reserves some values for each place that this rank sends, in memory that several arrays share.
    template <class T>
    T* sent_as(std::size_t values) {
        sent_.resize(windows_.sent_by(rank()).items() * values * sizeof(T));
        return reinterpret_cast<T*>(sent_.data());
    }

    Device& device_;
    std::size_t own_ = 0;       ///< number of this rank's Gaussians
    std::size_t received_ = 0;  ///< number of places for splats from others
    ranks::shares drawn_{0, 1, 1};
    std::vector<std::size_t> window_counts_{0};
    ranks::windows windows_{window_counts_, 1};
    buffer<std::uint32_t> marks_;
    buffer<std::uint32_t> gaussians_;  ///< of each place that this rank sends
    buffer<std::uint64_t> places_, counts_;
    typename Device::template host_buffer<std::uint64_t> counts_on_host_;
    typename Device::transfer counted_;
    buffer<char> sent_;  ///< splats for other ranks, and later the sums that these send back
    buffer<splat_reach> sent_reach_, received_reach_;
};

}  // namespace gs::raster
