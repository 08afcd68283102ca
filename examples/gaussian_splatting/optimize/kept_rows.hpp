// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../device/atomic.hpp"
#include "../device/device.hpp"
#include "../model/parameter_memory.hpp"
#include "parameter_storage.hpp"

namespace gs::train {

/// An array in host memory, and copies of some of its blocks in device memory.
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

/// The blocks and places of one fetch.
struct kept_exchange {
    std::uint32_t missing, free;  ///< number of missing blocks, and of places that are free for them
    std::uint32_t first;          ///< the place from which free places are searched

    WARPAGG_HD std::uint32_t count() const { return warpagg::math::min(missing, free); }
};

/// Begins a fetch. It takes other places than the last one, so that all places are used. One index.
struct begin_fetch {
    kept_exchange* exchange;
    std::uint32_t places;

    WARPAGG_HD void operator()(std::size_t) const {
        *exchange = {0, 0, (exchange->first + exchange->count()) % places};
    }
};

/// Lists the needed blocks without copies. One index per block.
struct list_missing {
    const std::uint32_t* needed;
    kept_tables tables;
    std::uint32_t* listed;
    kept_exchange* exchange;

    WARPAGG_HD void operator()(std::size_t block) const {
        if (needed[block] != 0 && tables.place_of[block] == 0)
            listed[device::atomic_add(&exchange->missing, 1u)] = static_cast<std::uint32_t>(block) + 1;
    }
};

/// Lists the places that are empty, or whose blocks are not needed. One index per place.
struct list_free {
    const std::uint32_t* needed;
    kept_tables tables;
    std::uint32_t places;
    std::uint32_t* listed;
    kept_exchange* exchange;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::uint32_t place = (exchange->first + static_cast<std::uint32_t>(i)) % places;
        const std::uint32_t block = tables.block_at[place];
        if (block == 0 || needed[block - 1] == 0) listed[device::atomic_add(&exchange->free, 1u)] = place + 1;
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

/// Gives missing blocks free places: writes the old block of the place back, and fetches the new one.
template <class W>
struct exchange_blocks {
    kept_copies copies;
    kept_tables tables;
    const std::uint32_t *missing, *free;
    const kept_exchange* exchange;
    std::uint32_t warps;  ///< number of warps, which share the blocks

    WARPAGG_HD void operator()(const W& w, unsigned warp) const {
        const std::uint32_t n = exchange->count();
        for (std::uint32_t i = warp; i < n; i += warps) {
            const std::uint32_t block = missing[i], place = free[i], old = tables.block_at[place - 1];
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
        missing_.resize(blocks);
        block_at_.resize(places_);
        free_.resize(places_);
        exchange_.resize(1);
        device.zero(exchange_.data(), 1);
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
        const kept_tables tables = this->tables();
        const auto places = static_cast<std::uint32_t>(places_);
        kept_exchange* const exchange = exchange_.data();
        device.for_each_index(1, begin_fetch{exchange, places});
        device.for_each_index(blocks_, list_missing{needed_.data(), tables, missing_.data(), exchange});
        device.for_each_index(places_, list_free{needed_.data(), tables, places, free_.data(), exchange});
        using warp = typename Device::narrow_warp;
        const std::size_t warps = std::min(places_, device.resident_warps());
        device.template for_each_warp<warp>(
            warps, exchange_blocks<warp>{copies_, tables, missing_.data(), free_.data(), exchange,
                                         static_cast<std::uint32_t>(warps)});
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
    typename Device::template buffer<std::uint32_t> place_of_, needed_, missing_, block_at_, free_;
    typename Device::template buffer<kept_exchange> exchange_;
    kept_copies copies_;
};

}  // namespace gs::train
