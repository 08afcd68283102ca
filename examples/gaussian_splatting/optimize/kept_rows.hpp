// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../device/device.hpp"
#include "../model/parameter_memory.hpp"
#include "parameter_storage.hpp"

namespace gs::train {

/// An array of SH coefficients or their moments, and copies of some of its blocks in device memory.
struct kept_array {
    std::uint32_t *all, *kept;
    std::uint32_t width;  ///< words of 32 bits per Gaussian
};

/// Which blocks have copies, and where. All arrays are in device memory. Indices are counted from 1; 0
/// means none.
struct kept_tables {
    std::uint32_t* place_of;  ///< by block: see `parameter_arrays::kept_place`
    std::uint32_t* block_at;  ///< by place: the block
};

/// The choice of blocks to fetch, and of places for them. Index i stands for block i, and then for place
/// i - blocks in the order in which places are taken. All arrays are in device memory.
struct kept_choice {
    const std::uint32_t* needed;  ///< by block: 1 or 0
    kept_tables tables;
    std::uint32_t blocks, places;
    std::uint32_t* first;       ///< the place to take first, so that all are taken in turn
    std::uint32_t* chosen;      ///< 1 for needed blocks without copies, and for places without needed blocks
    const std::uint64_t* rank;  ///< number of chosen ones before each index, and of all
    std::uint32_t* listed;      ///< the chosen blocks, and from index `blocks` on the chosen places

    WARPAGG_HD std::uint32_t place(std::size_t i) const {
        return (*first + static_cast<std::uint32_t>(i) - blocks) % places;
    }
    /// Returns the number of blocks to fetch.
    WARPAGG_HD std::uint32_t count() const {
        return static_cast<std::uint32_t>(
            warpagg::math::min(rank[blocks], rank[blocks + places] - rank[blocks]));
    }
};

/// Sets `chosen`. One index per block and place.
struct choose_kept {
    kept_choice choice;

    WARPAGG_HD void operator()(std::size_t i) const {
        const kept_choice& c = choice;
        if (i < c.blocks) {
            c.chosen[i] = c.needed[i] != 0 && c.tables.place_of[i] == 0 ? 1 : 0;
        } else {
            const std::uint32_t block = c.tables.block_at[c.place(i)];
            c.chosen[i] = block == 0 || c.needed[block - 1] == 0 ? 1 : 0;
        }
    }
};

/// Lists the chosen ones. One index per block and place.
struct list_chosen {
    kept_choice choice;

    WARPAGG_HD void operator()(std::size_t i) const {
        const kept_choice& c = choice;
        if (c.chosen[i] == 0) return;
        if (i < c.blocks)
            c.listed[c.rank[i]] = static_cast<std::uint32_t>(i) + 1;
        else
            c.listed[c.blocks + c.rank[i] - c.rank[c.blocks]] = c.place(i) + 1;
    }
};

/// Lets the next fetch begin with other places. One index.
struct turn_places {
    kept_choice choice;

    WARPAGG_HD void operator()(std::size_t) const {
        *choice.first = (*choice.first + choice.count()) % choice.places;
    }
};

/// The arrays of `kept_rows`, and the copies from and to host memory. A block is copied by one warp.
struct kept_copies {
    static constexpr std::size_t most = 3 * (parameter_count - static_cast<std::size_t>(parameter::sh1));

    kept_array arrays[most] = {};
    std::size_t count = 0;

    /// Adds the arrays of a `parameter_memory`.
    template <class Memory>
    void add(const Memory& memory) {
        memory.for_each_kept([&](auto* all, auto* kept, std::size_t width) {
            arrays[count++] = {reinterpret_cast<std::uint32_t*>(all), reinterpret_cast<std::uint32_t*>(kept),
                               static_cast<std::uint32_t>(width)};
        });
    }
    template <class W>
    WARPAGG_HD void write_back(const W& w, std::uint32_t block, std::uint32_t place) const {
        for (std::size_t a = 0; a < count; ++a)
            copy(w, block_of(arrays[a].all, a, block), block_of(arrays[a].kept, a, place), arrays[a].width);
    }
    template <class W>
    WARPAGG_HD void fetch(const W& w, std::uint32_t block, std::uint32_t place) const {
        for (std::size_t a = 0; a < count; ++a)
            copy(w, block_of(arrays[a].kept, a, place), block_of(arrays[a].all, a, block), arrays[a].width);
    }

  private:
    WARPAGG_HD std::uint32_t* block_of(std::uint32_t* array, std::size_t a, std::uint32_t index) const {
        return array + std::size_t{index - 1} * block_length * arrays[a].width;
    }
    /// Copies several rows at once, because a warp waits long for host memory.
    template <class W>
    static WARPAGG_HD void copy(const W& w, std::uint32_t* to, const std::uint32_t* from,
                                std::uint32_t width) {
        constexpr unsigned at_once = 8;
        const unsigned rows = width * static_cast<unsigned>(block_length) / W::size;
        for (unsigned first = 0; first < rows; first += at_once) {
            warpagg::value_t<W, std::uint32_t> words[at_once];
            WARPAGG_UNROLL
            for (unsigned k = 0; k < at_once; ++k)
                if (first + k < rows) words[k] = w.load_row(from, std::ptrdiff_t{(first + k) * W::size});
            WARPAGG_UNROLL
            for (unsigned k = 0; k < at_once; ++k)
                if (first + k < rows)
                    w.store_row(to, std::ptrdiff_t{(first + k) * W::size}, words[k],
                                warpagg::mask_t<W>(true));
        }
    }
};

/// Writes the old blocks of the chosen places back, and fetches the chosen blocks to them.
template <class W>
struct exchange_blocks {
    kept_copies copies;
    kept_choice choice;
    std::uint32_t warps;  ///< number of warps, which share the blocks

    WARPAGG_HD void operator()(const W& w, unsigned warp) const {
        const kept_tables& tables = choice.tables;
        const std::uint32_t n = choice.count();
        for (std::uint32_t i = warp; i < n; i += warps) {
            const std::uint32_t block = choice.listed[i], place = choice.listed[choice.blocks + i],
                                old = tables.block_at[place - 1];
            if (old != 0) copies.write_back(w, old, place);
            copies.fetch(w, block, place);
            w.sync();
            set(w, tables.block_at, place - 1, block);
            if (old != 0) set(w, tables.place_of, old - 1, 0);
            set(w, tables.place_of, block - 1, place);
        }
    }

  private:
    static WARPAGG_HD void set(const W& w, std::uint32_t* table, std::uint32_t at, std::uint32_t to) {
        using number = warpagg::value_t<W, std::uint32_t>;
        w.store(table, number(at), number(to), w.lane() == number(0u));
    }
};

/// Writes all copies back. One place per warp.
template <class W>
struct write_all_back {
    kept_copies copies;
    kept_tables tables;

    WARPAGG_HD void operator()(const W& w, unsigned place) const {
        if (const std::uint32_t block = tables.block_at[place]; block != 0)
            copies.write_back(w, block, place + 1);
    }
};

/// Copies, in device memory, of the blocks of parameters in host memory that views show. They replace
/// the blocks until they are written back. Without them, kernels would read and write host memory
/// several times in a step, and again in steps of other views. Results do not depend on the copies.
template <device::device Device>
class kept_rows {
  public:
    /// Sets the number of blocks, of which none is kept. Removes all arrays. Returns the number
    /// of places.
    std::size_t reset(Device& device, std::size_t blocks) {
        blocks_ = blocks;
        places_ = (blocks + kept_share - 1) / kept_share;
        place_of_.resize(blocks);
        needed_.resize(blocks);
        block_at_.resize(places_);
        chosen_.resize(blocks + places_);
        listed_.resize(blocks + places_);
        rank_.resize(blocks + places_ + 1);
        first_.resize(1);
        device.zero(first_.data(), 1);
        device.zero(place_of_.data(), blocks);
        device.zero(block_at_.data(), places_);
        copies_ = {};
        return places_;
    }
    std::size_t blocks() const { return blocks_; }
    /// Forgets all copies.
    void stop() { blocks_ = 0; }
    const std::uint32_t* place_of() const { return place_of_.data(); }
    /// Adds the arrays of a `parameter_memory`, after `parameter_memory::keep_blocks`.
    template <class Memory>
    void add(const Memory& memory) {
        copies_.add(memory);
    }

    /// Whether the next `fetch` needs a block: 1 or 0 for each.
    std::uint32_t* needed() const { return needed_.data(); }
    /// Fetches the needed blocks, as many as there are places.
    void fetch(Device& device) {
        if (blocks_ == 0) return;
        const std::size_t n = blocks_ + places_;
        const kept_choice choice{needed_.data(),
                                 tables(),
                                 static_cast<std::uint32_t>(blocks_),
                                 static_cast<std::uint32_t>(places_),
                                 first_.data(),
                                 chosen_.data(),
                                 rank_.data(),
                                 listed_.data()};
        device.for_each_index(n, choose_kept{choice});
        device.prefix_sum(chosen_, rank_, n);
        device.for_each_index(n, list_chosen{choice});
        using warp = typename Device::narrow_warp;
        const std::size_t warps = std::min(places_, device.resident_warps());
        device.template for_each_warp<warp>(
            warps, exchange_blocks<warp>{copies_, choice, static_cast<std::uint32_t>(warps)});
        device.for_each_index(1, turn_places{choice});
    }
    /// Writes all copies back, and keeps none.
    void write_back(Device& device) {
        if (blocks_ == 0) return;
        using warp = typename Device::narrow_warp;
        device.template for_each_warp<warp>(places_, write_all_back<warp>{copies_, tables()});
        device.zero(place_of_.data(), blocks_);
        device.zero(block_at_.data(), places_);
    }

  private:
    kept_tables tables() const { return {place_of_.data(), block_at_.data()}; }

    std::size_t blocks_ = 0, places_ = 0;
    typename Device::template buffer<std::uint32_t> place_of_, needed_, block_at_, chosen_, listed_, first_;
    typename Device::template buffer<std::uint64_t> rank_;
    kept_copies copies_;
};

}  // namespace gs::train
