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

/// An array of SH coefficients or their moments, and those of its blocks that are in the cache.
struct cached_array {
    std::uint32_t *all, *cached;
    std::uint32_t width;  ///< words of 32 bits per Gaussian
};

/// Which blocks are in the cache, and where. All arrays are in device memory. Indices are counted from 1; 0
/// means none.
struct cache_tables {
    std::uint32_t* slot_of;   ///< by block: see `parameter_arrays::cache_slot`
    std::uint32_t* block_in;  ///< by slot: the block
};

/// The choice of blocks to fetch, and of slots for them. Index i stands for block i, and then for slot
/// i - blocks in the order in which slots are taken. All arrays are in device memory.
struct fetch_choice {
    const std::uint32_t* needed;  ///< by block: 1 or 0
    cache_tables tables;
    std::uint32_t blocks, slots;
    std::uint32_t* first;       ///< the slot to take first, so that all are taken in turn
    std::uint32_t* chosen;      ///< 1 for needed blocks to fetch, and for slots without needed blocks
    const std::uint64_t* rank;  ///< number of chosen ones before each index, and of all
    std::uint32_t* listed;      ///< the chosen blocks, and from index `blocks` on the chosen slots

    WARPAGG_HD std::uint32_t slot(std::size_t i) const {
        return (*first + static_cast<std::uint32_t>(i) - blocks) % slots;
    }
    /// Returns the number of blocks to fetch.
    WARPAGG_HD std::uint32_t count() const {
        return static_cast<std::uint32_t>(
            warpagg::math::min(rank[blocks], rank[blocks + slots] - rank[blocks]));
    }
};

/// Sets `chosen`. One index per block and slot.
struct choose_blocks {
    fetch_choice choice;

    WARPAGG_HD void operator()(std::size_t i) const {
        const fetch_choice& c = choice;
        if (i < c.blocks) {
            c.chosen[i] = c.needed[i] != 0 && c.tables.slot_of[i] == 0 ? 1 : 0;
        } else {
            const std::uint32_t block = c.tables.block_in[c.slot(i)];
            c.chosen[i] = block == 0 || c.needed[block - 1] == 0 ? 1 : 0;
        }
    }
};

/// Lists the chosen ones. One index per block and slot.
struct list_chosen {
    fetch_choice choice;

    WARPAGG_HD void operator()(std::size_t i) const {
        const fetch_choice& c = choice;
        if (c.chosen[i] == 0) return;
        if (i < c.blocks)
            c.listed[c.rank[i]] = static_cast<std::uint32_t>(i) + 1;
        else
            c.listed[c.blocks + c.rank[i] - c.rank[c.blocks]] = c.slot(i) + 1;
    }
};

/// Lets the next fetch begin with other slots. One index.
struct turn_slots {
    fetch_choice choice;

    WARPAGG_HD void operator()(std::size_t) const {
        *choice.first = (*choice.first + choice.count()) % choice.slots;
    }
};

/// The arrays of a `block_cache`. One warp copies a block from or to the cache.
struct cached_arrays {
    static constexpr std::size_t most = 3 * (parameter_count - static_cast<std::size_t>(parameter::sh1));

    cached_array arrays[most] = {};
    std::size_t count = 0;

    /// Adds the arrays of a `parameter_memory`.
    template <class Memory>
    void add(const Memory& memory) {
        memory.for_each_cached([&](auto* all, auto* cached, std::size_t width) {
            arrays[count++] = {reinterpret_cast<std::uint32_t*>(all),
                               reinterpret_cast<std::uint32_t*>(cached), static_cast<std::uint32_t>(width)};
        });
    }
    template <class W>
    WARPAGG_HD void write_back(const W& w, std::uint32_t block, std::uint32_t slot) const {
        for (std::size_t a = 0; a < count; ++a)
            copy(w, block_of(arrays[a].all, a, block), block_of(arrays[a].cached, a, slot), arrays[a].width);
    }
    template <class W>
    WARPAGG_HD void fetch(const W& w, std::uint32_t block, std::uint32_t slot) const {
        for (std::size_t a = 0; a < count; ++a)
            copy(w, block_of(arrays[a].cached, a, slot), block_of(arrays[a].all, a, block), arrays[a].width);
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

/// Writes the old blocks of the chosen slots back, and fetches the chosen blocks to them.
template <class W>
struct exchange_blocks {
    cached_arrays arrays;
    fetch_choice choice;
    std::uint32_t warps;  ///< number of warps, which share the blocks

    WARPAGG_HD void operator()(const W& w, unsigned warp) const {
        const cache_tables& tables = choice.tables;
        const std::uint32_t n = choice.count();
        for (std::uint32_t i = warp; i < n; i += warps) {
            const std::uint32_t block = choice.listed[i], slot = choice.listed[choice.blocks + i],
                                old = tables.block_in[slot - 1];
            if (old != 0) arrays.write_back(w, old, slot);
            arrays.fetch(w, block, slot);
            w.sync();
            set(w, tables.block_in, slot - 1, block);
            if (old != 0) set(w, tables.slot_of, old - 1, 0);
            set(w, tables.slot_of, block - 1, slot);
        }
    }

  private:
    static WARPAGG_HD void set(const W& w, std::uint32_t* table, std::uint32_t at, std::uint32_t to) {
        using number = warpagg::value_t<W, std::uint32_t>;
        w.store(table, number(at), number(to), w.lane() == number(0u));
    }
};

/// Writes all blocks of the cache back. One slot per warp.
template <class W>
struct write_cache_back {
    cached_arrays arrays;
    cache_tables tables;

    WARPAGG_HD void operator()(const W& w, unsigned slot) const {
        if (const std::uint32_t block = tables.block_in[slot]; block != 0)
            arrays.write_back(w, block, slot + 1);
    }
};

/// A cache in device memory for blocks of parameters in host memory. Without it, kernels would read and
/// write host memory several times in a step, and again in steps of other views. Kernels use the cached
/// block instead of its original until it is written back. Results do not depend on the cache.
template <device::device Device>
class block_cache {
  public:
    /// Empties the cache, removes all arrays, and sets the number of blocks. Returns the number of slots.
    std::size_t reset(Device& device, std::size_t blocks) {
        blocks_ = blocks;
        slots_ = (blocks + blocks_per_slot - 1) / blocks_per_slot;
        slot_of_.resize(blocks);
        needed_.resize(blocks);
        block_in_.resize(slots_);
        chosen_.resize(blocks + slots_);
        listed_.resize(blocks + slots_);
        rank_.resize(blocks + slots_ + 1);
        first_.resize(1);
        device.zero(first_.data(), 1);
        device.zero(slot_of_.data(), blocks);
        device.zero(block_in_.data(), slots_);
        arrays_ = {};
        return slots_;
    }
    std::size_t blocks() const { return blocks_; }
    /// Forgets all blocks.
    void drop() { blocks_ = 0; }
    const std::uint32_t* slot_of() const { return slot_of_.data(); }
    /// Adds the arrays of a `parameter_memory`, after `parameter_memory::reserve_cache`.
    template <class Memory>
    void add(const Memory& memory) {
        arrays_.add(memory);
    }

    /// Returns the array that tells the next `fetch` which blocks it needs: 1 or 0 for each.
    std::uint32_t* needed() const { return needed_.data(); }
    /// Fetches the needed blocks, as many as there are slots.
    void fetch(Device& device) {
        if (blocks_ == 0) return;
        const std::size_t n = blocks_ + slots_;
        const fetch_choice choice{needed_.data(),
                                  tables(),
                                  static_cast<std::uint32_t>(blocks_),
                                  static_cast<std::uint32_t>(slots_),
                                  first_.data(),
                                  chosen_.data(),
                                  rank_.data(),
                                  listed_.data()};
        device.for_each_index(n, choose_blocks{choice});
        device.prefix_sum(chosen_, rank_, n);
        device.for_each_index(n, list_chosen{choice});
        using warp = typename Device::narrow_warp;
        const std::size_t warps = std::min(slots_, device.resident_warps());
        device.template for_each_warp<warp>(
            warps, exchange_blocks<warp>{arrays_, choice, static_cast<std::uint32_t>(warps)});
        device.for_each_index(1, turn_slots{choice});
    }
    /// Writes all blocks back, and empties the cache.
    void write_back(Device& device) {
        if (blocks_ == 0) return;
        using warp = typename Device::narrow_warp;
        device.template for_each_warp<warp>(slots_, write_cache_back<warp>{arrays_, tables()});
        device.zero(slot_of_.data(), blocks_);
        device.zero(block_in_.data(), slots_);
    }

  private:
    cache_tables tables() const { return {slot_of_.data(), block_in_.data()}; }

    std::size_t blocks_ = 0, slots_ = 0;
    typename Device::template buffer<std::uint32_t> slot_of_, needed_, block_in_, chosen_, listed_, first_;
    typename Device::template buffer<std::uint64_t> rank_;
    cached_arrays arrays_;
};

}  // namespace gs::train
