// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <warpagg/match_reduce_atomic.hpp>
#include <warpagg/segmented_sum.hpp>

#include "adder.hpp"
#include "device/stages.hpp"

/// Every lane adds its value to its sum: a warp after the other takes the next ones, all at the same time.
template <class Accumulate, class Cell>
struct add_values {
    const float* values;
    const std::uint32_t* keys;
    unsigned n;
    bool is_one_sum;
    Cell* cells;
    Accumulate how;

    WARPAGG_EXEC_CHECK_DISABLE
    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        using namespace warpagg;
        const auto place = w.lane() + index * W::size;
        const mask_t<W> inside = place < n;
        const auto key = w.load(keys, place, inside);
        const mask_t<W> active = inside && key != problem::nowhere;
        const value_t<W, float> v[1] = {w.load(values, place, active)};
        const policy all{how};
        if (is_one_sum)
            warp_reduce_atomic<float, 1>(w, cells, v, active, all);
        else
            warp_match_reduce_atomic(w, cells, key, v, active, all);
    }
};

/// One index a value.
/// @{
struct number_values {
    std::uint32_t* numbers;
    WARPAGG_HD void operator()(std::size_t i) const { numbers[i] = static_cast<std::uint32_t>(i); }
};
struct gather_values {
    const float* from;
    const std::uint32_t* numbers;
    float* to;
    WARPAGG_HD void operator()(std::size_t i) const { to[i] = from[numbers[i]]; }
};
/// @}

template <class Device>
class adder_on final : public adder {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using warp = typename Device::warp;

  public:
    std::string device() const override { return device_.name(); }
    unsigned lanes() const override { return warp::size; }

    void put(const problem& p) override {
        n_ = p.values.size();
        sums_ = p.sums;
        values_.resize(n_);
        keys_.resize(n_);
        device_.upload(values_.data(), p.values.data(), n_);
        device_.upload(keys_.data(), p.keys.data(), n_);
        device_.wait();
        active_ = static_cast<std::size_t>(
            std::ranges::count_if(p.keys, [](std::uint32_t k) { return k != problem::nowhere; }));
        largest_ = 0;
        for (const float x : p.values) largest_ = std::max(largest_, std::abs(x));
    }

    std::vector<float> add_up(way how) override {
        namespace accumulate = warpagg::accumulate;
        switch (how) {
            case way::native:
                return add_up<float>(accumulate::native{});
            case way::f64:
                return add_up_to_cells(accumulate::f64{});
            case way::compensated:
                return add_up_to_cells(accumulate::compensated{});
            case way::fixed: {
                const fixed_way scaled{nullptr, fixed_way::scale_to_fit(largest_)};
                std::vector<float> sums = add_up_to_cells(scaled);
                for (float& s : sums) s /= scaled.scale;
                return sums;
            }
            case way::binned2:
                return add_up_to_cells(accumulate::binned<2>{});
            case way::binned3:
                return add_up_to_cells(accumulate::binned<3>{});
            case way::exact:
                return add_up_to_cells(accumulate::exact{});
            case way::ordered:
                return add_up_in_order();
        }
        return {};
    }
    double nanoseconds() const override { return nanoseconds_; }

  private:
    template <class Accumulate>
    std::vector<float> add_up_to_cells(const Accumulate& how) {
        return add_up<warpagg::accumulator<Accumulate>>(how);
    }

    /// Runs f, and notes how long that took.
    template <class F>
    void time(const F& f) {
        device_.sample_times(1);
        device_.begin(gs::device::stage::blend_backward);  // of the clock's stages any would do
        f();
        device_.end_iteration();
        const auto times = device_.times();
        nanoseconds_ = 1e6 * times.milliseconds[static_cast<std::size_t>(gs::device::stage::blend_backward)];
    }

    /// The time includes sorting.
    std::vector<float> add_up_in_order() {
        using tiles = warpagg::segmented_sum_tiles<float>;
        const auto n = static_cast<unsigned>(active_);
        const std::size_t edges = 2 * tiles::tiles(n);
        for (auto* b : {&sorted_keys_, &numbers_}) b->resize(n_);
        sorted_values_.resize(active_);
        ordered_sums_.resize(sums_);
        edge_keys_.resize(edges);
        edge_sums_.resize(edges);
        device_.copy(sorted_keys_.data(), keys_.data(), n_);
        device_.for_each_index(n_, number_values{numbers_.data()});
        device_.zero(ordered_sums_.data(), sums_);
        time([&] {
            device_.sort_pairs(sorted_keys_, numbers_, n_);
            device_.for_each_index(active_,
                                   gather_values{values_.data(), numbers_.data(), sorted_values_.data()});
            device_.for_each_warp(tiles::tiles(n),
                                  tiles{sorted_keys_.data(), sorted_values_.data(), n, ordered_sums_.data(),
                                        edge_keys_.data(), edge_sums_.data()});
            device_.for_each_index(
                edges, warpagg::segmented_sum_fixup<float>{edge_keys_.data(), edge_sums_.data(), edges,
                                                           ordered_sums_.data()});
        });
        std::vector<float> sums(sums_);
        device_.download(sums.data(), ordered_sums_.data(), sums_);
        return sums;
    }

    template <class Cell, class Accumulate>
    std::vector<float> add_up(const Accumulate& how) {
        static_assert(sizeof(Cell) % sizeof(std::uint32_t) == 0);
        const std::size_t words = sums_ * (sizeof(Cell) / sizeof(std::uint32_t));
        memory_.resize((words + 1) / 2);
        device_.zero(memory_.data(), memory_.size());
        auto* const cells = reinterpret_cast<Cell*>(memory_.data());
        time([&] {
            device_.for_each_warp(
                (n_ + warp::size - 1) / warp::size,
                add_values<Accumulate, Cell>{values_.data(), keys_.data(), static_cast<unsigned>(n_),
                                             sums_ == 1, cells, how});
        });
        std::vector<Cell> found(sums_);
        device_.download(found.data(), cells, sums_);
        std::vector<float> sums;
        for (const Cell& c : found) {
            if constexpr (std::is_same_v<Cell, float>) {
                sums.push_back(c);
            } else {
                sums.push_back(c.value());
            }
        }
        return sums;
    }

    Device device_;
    buffer<float> values_, sorted_values_, ordered_sums_, edge_sums_;
    buffer<std::uint32_t> keys_, sorted_keys_, numbers_, edge_keys_;
    buffer<std::uint64_t> memory_;
    std::size_t n_ = 0, active_ = 0, sums_ = 0;
    float largest_ = 0;
    double nanoseconds_ = 0;
};
