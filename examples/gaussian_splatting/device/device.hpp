// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The concept `device`: the requirements of the trainer on a device, which stores its data and
/// runs its kernels. Its models are `cpu`, which uses OpenMP, and `cuda`.
///
/// Kernels are function objects whose members are values and pointers to device memory. They run in
/// the order of their launches. Only members whose description mentions it wait for the device.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <warpagg/warp/concept.hpp>

#include "../ranks/communicator.hpp"
#include "distribute.hpp"
#include "memory_place.hpp"
#include "stages.hpp"

namespace gs::device {

/// Argument types with which the concept checks the members of a device.
namespace archetype {

struct index_kernel {
    void operator()(std::size_t) const;
};
struct warp_kernel {
    template <warpagg::warp W>
    void operator()(const W&, unsigned) const;
};
struct range {
    std::uint32_t begin, end;
};
struct item {
    std::uint32_t value;
    std::uint32_t size() const;
    std::uint32_t bucket(std::uint32_t) const;
};
struct item_list {
    item operator()(std::size_t) const;
};
struct host_work {
    void operator()() const;
};

}  // namespace archetype

/// `D::buffer<T>`: an array of trivially copyable values in device memory, empty at first.
/// - `resize(n)`: sets the size. If n exceeds all previous sizes, allocates and loses the contents.
/// - `data()`, `size()`: pointer to device memory, number of values.
template <class B, class T>
concept buffer_of = std::movable<B> && std::default_initializable<B> && requires(B b, const B c) {
    b.resize(std::size_t{});
    { c.data() } -> std::same_as<T*>;
    { c.size() } -> std::same_as<std::size_t>;
};

/// `D::host_buffer<T>`: the same in host memory, for `begin_upload` and `begin_download`.

/// A buffer of a device that can also lie in host memory, where kernels still reach it.
/// - `free_in(place)`: frees the memory. Later calls of `resize` allocate in this place, at first in
///   device memory. If the device shares the host's memory, both places are the same.
template <class B>
concept placed_buffer = requires(B b) {
    b.free_in(memory_place::host);
};

/// A device. All pointers are to its memory, except the host side of copies from and to the host.
///
/// Types
/// - `warp`: the model of `warpagg::warp` that kernels run on.
/// - `narrow_warp`: the same for kernels that hold many values per lane; may have fewer lanes.
/// - `buffer<T>`: see `buffer_of` and `placed_buffer`.
/// - `host_buffer<T>`: see `buffer_of`.
/// - `transfer`: a copy by `begin_upload` or `begin_download`. `is_done()` returns whether it has
///   finished, or was never begun. `wait()` waits for it.
///
/// Properties
/// - `name()`: kind and model for reports, such as "cuda, NVIDIA H200".
/// - `resident_warps()`: number of warps that keep the whole device busy.
/// - `peak_bytes()`: largest amount of device memory in use so far; zero if it is host memory.
/// - `shares_host_memory`: whether device memory is host memory.
/// - `used_bytes()`: size of all buffers of this process.
/// - `free_bytes()`: amount of device memory that new buffers can take.
///
/// Launches
/// - `for_each_index(n, f)`: runs `f(i)` for each i in [0, n).
/// - `for_each_warp<W>(n, f)`: runs `f(W{}, i)` for each i in [0, n), on one warp each. W is `warp`
///   by default. A kernel that `has_scratch` gets its scratch memory as a third argument.
///   Both also take a `ranks::share` of the indices instead of n.
/// - `iteration(key, f)`: runs `f()`, which launches one training iteration. `f` does not wait,
///   and allocates only in the first iteration with this key. From the second one on, a device may
///   capture the launches and submit them as one graph.
/// - `wait()`: returns when all earlier launches and copies have finished.
///
/// Copies of n values
/// - `zero(p, n)`: sets them to zero.
/// - `copy(to, from, n)`: copies them within the device; the arrays do not overlap.
/// - `upload(to, from, n)`: copies them from the host, where they must stay until the next `wait`.
/// - `download(to, from, n)`: copies them to the host. Waits.
/// - `begin_upload(transfer, to, from, n)`: copies them from a `host_buffer`. The copy begins after
///   all earlier launches and runs beside later ones.
/// - `await(transfer)`: later launches begin after this copy.
/// - `begin_download(transfer, to, from, n)`: copies them to a `host_buffer`, after all earlier
///   launches.
///
/// Algorithms
/// - `prefix_sum(in, out, n)`: `out[i] = in[0] + ... + in[i - 1]` for i in [0, n].
/// - `sort_pairs(keys, values, n)`: stable sort of the first n pairs by key; n < 2^30. May exchange
///   the memory of the buffers.
/// - `place_lists(n, items, buckets, capacity, ranges, required)`: gives each bucket a list of the `items`
///   [0, n) that go there. Bucket b's list is `[ranges[b].begin, ranges[b].end)`; buckets follow one
///   another. Writes the length of all lists together to `*required`. Cuts them off at `capacity`.
/// - `write_lists(n, items, buckets, places, listed, ranges)`: writes the values of the same items to their
///   lists, which are parts of `listed`, in the order of the items. The ranges may all have moved by the
///   same number. Writes nothing at or behind `places`. Lists that have been cut off may be followed by other
///   values.
///
/// Ranks: processes that train one model together, with a device each
/// - `join(ranks)`: makes the device one of these. At first it is the only one.
/// - `ranks()`: the ranks, for values on the host.
/// - `sum_over_ranks(p, n)`: gives all ranks the sums of n values in device memory: see
///   `ranks::communicator::sum`.
/// - `gather(shares, arrays)`: gives all ranks the shares of the others: see
///   `ranks::communicator::gather`.
/// - `exchange(windows, arrays)`: sends each rank its windows: see `ranks::communicator::exchange`.
///
/// Times of an iteration's stages
/// - `begin(stage)`: marks where a stage begins.
/// - `end_iteration()`: marks where the iteration ends; `iteration` calls it.
/// - `pause_times(paused)`: excludes the launches that follow.
/// - `sample_times(n)`: times every n-th iteration from now on, and forgets earlier times.
/// - `times()`: the sums since `sample_times`. Waits for the last timed iteration.
template <class D>
concept device = std::default_initializable<D> && warpagg::warp<typename D::warp> &&
                 warpagg::warp<typename D::narrow_warp> && buffer_of < typename D::template buffer<float>,
float > &&requires(D d, const D c, std::size_t n, float* p, const float* from, std::uint32_t* listed,
                   archetype::range* ranges, std::uint64_t* required,
                   typename D::template buffer<std::uint32_t> numbers,
                   typename D::template buffer<std::uint64_t> sums, typename D::transfer& transfer,
                   ranks::communicator& ranks, const ranks::share& part, const ranks::shares& shares,
                   std::span<const ranks::shared_array> arrays, const ranks::windows& windows,
                   std::span<const ranks::window_array> window_arrays) {
    { c.name() } -> std::same_as<std::string>;
    { c.resident_warps() } -> std::same_as<std::size_t>;
    d.for_each_index(n, archetype::index_kernel{});
    d.for_each_warp(n, archetype::warp_kernel{});
    d.template for_each_warp<typename D::narrow_warp>(n, archetype::warp_kernel{});
    d.for_each_index(part, archetype::index_kernel{});
    d.template for_each_warp<typename D::narrow_warp>(part, archetype::warp_kernel{});
    d.zero(p, n);
    d.copy(p, from, n);
    d.upload(p, from, n);
    d.download(p, from, n);
    requires buffer_of < typename D::template host_buffer<float>,
    float > ;
    requires placed_buffer<typename D::template buffer<float>>;
    d.begin_upload(transfer, p, from, n);
    d.await(transfer);
    d.begin_download(transfer, p, from, n);
    { transfer.is_done() } -> std::same_as<bool>;
    transfer.wait();
    d.prefix_sum(numbers, sums, n);
    d.sort_pairs(numbers, numbers, n);
    d.place_lists(n, archetype::item_list{}, n, std::uint64_t{}, ranges, required);
    d.write_lists(n, archetype::item_list{}, n, std::uint64_t{}, listed, ranges);
    d.iteration(graph_key{}, archetype::host_work{});
    d.join(ranks);
    { d.ranks() } -> std::same_as<ranks::communicator&>;
    d.sum_over_ranks(p, n);
    d.gather(shares, arrays);
    d.exchange(windows, window_arrays);
    d.begin(stage::project);
    d.pause_times(true);
    d.sample_times(1);
    { d.times() } -> std::convertible_to<stage_times>;
    { c.peak_bytes() } -> std::same_as<std::size_t>;
    { D::shares_host_memory } -> std::convertible_to<bool>;
    { c.used_bytes() } -> std::same_as<std::size_t>;
    { c.free_bytes() } -> std::same_as<std::size_t>;
    d.wait();
};

}  // namespace gs::device
