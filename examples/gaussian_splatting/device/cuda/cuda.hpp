// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <algorithm>
#include <cstdint>
#include <cub/device/device_scan.cuh>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <warpagg/atomic.hpp>

#include "../device.hpp"
#include "../scratch.hpp"
#include "distribute.hpp"
#include "graph.hpp"
#include "memory.hpp"
#include "peers.hpp"
#include "sort.hpp"
#include "times.hpp"
#include "transfer.hpp"

namespace gs::device {

namespace detail {

constexpr unsigned block_size = 128;
constexpr unsigned warps_per_block = block_size / 32;

struct wide_sum {
    __device__ std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

/// The first n numbers of a sequence, followed by zeros.
template <class Numbers>
struct and_a_zero {
    Numbers numbers;
    std::size_t n;
    WARPAGG_HD std::uint64_t operator()(std::size_t i) const { return i < n ? numbers[i] : 0; }
};
/// The sizes of items, as a sequence.
template <class Items>
struct sizes_of {
    Items all;
    WARPAGG_HD std::uint32_t operator[](std::size_t i) const { return all(i).size(); }
};

template <class F>
__global__ void for_each_index(std::size_t first, std::size_t last, F f) {
    await_kernel_before();
    const std::size_t i = first + std::size_t{blockIdx.x} * block_size + threadIdx.x;
    if (i < last) f(i);
}

/// The minimum number of resident blocks per multiprocessor. A kernel may set `warps_at_once` to
/// the number of its warps that a multiprocessor must hold. The compiler then limits the kernel's
/// registers.
template <class F>
constexpr int least_blocks = 1;
template <class F>
requires requires { F::warps_at_once; }
constexpr int least_blocks<F> = F::warps_at_once / warps_per_block;

template <class F>
__global__ void __launch_bounds__(block_size, least_blocks<F>)
    for_each_warp(unsigned first, unsigned last, F f) {
    await_kernel_before();
    const unsigned i = first + blockIdx.x * warps_per_block + threadIdx.x / 32;
    using warp = warpagg::cuda_warp;
    if constexpr (has_scratch<F, warp>) {
        __shared__ typename F::template scratch<warp> scratch[warps_per_block];
        if (i < last) f(warp{}, i, scratch[threadIdx.x / 32]);
    } else {
        if (i < last) f(warp{}, i);
    }
}

}  // namespace detail

/// The model of `device` for an NVIDIA GPU: the current CUDA device, one stream on it, and a second
/// one for `begin_upload`. Throws `error` if the GPU is out of memory.
class cuda {
  public:
    static constexpr bool shares_host_memory = false;
    using warp = warpagg::cuda_warp;
    using narrow_warp = warp;

    template <class T>
    using buffer = cuda_buffer<T>;
    template <class T>
    using host_buffer = page_locked_buffer<T>;
    using transfer = cuda_transfer;

    cuda() : times_(stream_) {
        int processors = 0;
        check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, 0));
        resident_warps_ = 32 * static_cast<std::size_t>(processors);
        cudaFuncAttributes kernel{};
        check(cudaFuncGetAttributes(&kernel, detail::count_digits<std::uint32_t>));
        kernels_await_ = kernel.ptxVersion >= 90;
        slices_done_.resize(1);
        zero(slices_done_.data(), 1);
    }
    cuda(const cuda&) = delete;
    cuda& operator=(const cuda&) = delete;

    std::string name() const {
        cudaDeviceProp properties{};
        check(cudaGetDeviceProperties(&properties, 0));
        return std::string("cuda, ") + properties.name;
    }

    std::size_t resident_warps() const { return resident_warps_; }

    template <class F>
    void for_each_index(const gs::ranks::share& part, const F& f) {
        launch(detail::for_each_index<F>, blocks(part.count(), detail::block_size), detail::block_size, 0,
               part.first, part.last, f);
    }
    template <class F>
    void for_each_index(std::size_t n, const F& f) {
        for_each_index(gs::ranks::share{0, n}, f);
    }
    template <class W = warp, class F>
    void for_each_warp(const gs::ranks::share& part, const F& f) {
        launch(detail::for_each_warp<F>, blocks(part.count(), detail::warps_per_block), detail::block_size, 0,
               static_cast<unsigned>(part.first), static_cast<unsigned>(part.last), f);
    }
    template <class W = warp, class F>
    void for_each_warp(std::size_t n, const F& f) {
        for_each_warp<W>(gs::ranks::share{0, n}, f);
    }

    template <class T>
    void zero(T* p, std::size_t n) {
        if (n > 0) check(cudaMemsetAsync(p, 0, n * sizeof(T), stream_));
    }
    template <class T>
    void copy(T* to, const T* from, std::size_t n) {
        check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDefault, stream_));
    }
    template <class T>
    void upload(T* to, const T* from, std::size_t n) {
        check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDefault, stream_));
    }
    template <class T>
    void download(T* to, const T* from, std::size_t n) {
        check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDefault, stream_));
        wait();
    }

    template <class T>
    void begin_upload(transfer& upload, T* to, const T* from, std::size_t n) {
        check(cudaEventRecord(launched_.event, stream_));
        check(cudaStreamWaitEvent(upload_stream_, launched_.event));
        check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyHostToDevice, upload_stream_));
        check(cudaEventRecord(upload.event, upload_stream_));
    }
    void await(const transfer& upload) { check(cudaStreamWaitEvent(stream_, upload.event)); }
    template <class T>
    void begin_download(transfer& download, T* to, const T* from, std::size_t n) {
        check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDeviceToHost, stream_));
        check(cudaEventRecord(download.event, stream_));
    }

    void prefix_sum(const buffer<std::uint32_t>& in, buffer<std::uint64_t>& out, std::size_t n) {
        prefix_sum_of(in.data(), out, n);
    }

    template <items Items, class Range>
    void place_lists(std::size_t n, const Items& all, std::size_t buckets, std::uint64_t capacity,
                     Range* ranges, std::uint64_t* required) {
        using namespace detail;
        if (buckets == 0) return zero(required, 1);
        first_candidate_.resize(n + 1);
        prefix_sum_of(sizes_of<Items>{all}, first_candidate_, n);
        with_slices(n, buckets, [&]<unsigned Slices, bool Shared>(unsigned b, std::size_t row) {
            table_.resize(Slices * buckets);
            launch(count_slice<Slices, Shared, Items>, Slices, counting_warps * warp_size, row, all,
                   first_candidate_.data(), n, b, table_.data());
            launch(place_buckets<Slices, Range>, blocks(buckets, warp_size), placing_warps * warp_size, 0, b,
                   table_.data(), capacity, ranges, required, slices_done_.data());
        });
    }
    template <items Items, class Range>
    void write_lists(std::size_t n, const Items& all, std::size_t buckets, std::uint64_t places,
                     std::uint32_t* listed, const Range* ranges) {
        using namespace detail;
        with_slices(n, buckets, [&]<unsigned Slices, bool Shared>(unsigned b, std::size_t row) {
            launch(append_slice<Slices, Shared, Items, Range>, Slices, warp_size, row, all,
                   first_candidate_.data(), n, b, table_.data(), places, ranges, listed);
        });
    }

    void sort_pairs(buffer<std::uint32_t>& keys, buffer<std::uint32_t>& values, std::size_t n) {
        using namespace detail;
        other_keys_.resize(n);
        other_values_.resize(n);
        const unsigned tiles = blocks(n, keys_a_tile), count = static_cast<unsigned>(n);
        sort_memory_.resize(sort_memory::size(tiles));
        zero(sort_memory_.data(), sort_memory_.size());
        constexpr unsigned most_blocks = 512;
        launch(count_digits<std::uint32_t>, std::min(tiles, most_blocks), sorting_threads, 0, keys.data(),
               count, sort_memory_.data());
        std::uint32_t *from[] = {keys.data(), values.data()},
                      *to[] = {other_keys_.data(), other_values_.data()};
        static_assert(digits_a_key % 2 == 0);  // leaves the result in `keys` and `values`
        for (unsigned digit = 0; digit < digits_a_key; ++digit, std::swap(from, to))  // knob: radix_passes
            launch(sort_by_digit<std::uint32_t, std::uint32_t>, tiles, sorting_threads, 0, from[0], from[1],
                   count, digit * digit_bits, sort_memory(sort_memory_.data(), tiles, digit), to[0], to[1]);
    }

    /// Runs an iteration. Iterations with equal keys need the same memory, which the first one
    /// allocates. The launches of later ones are captured and submitted as one graph, because a
    /// capture cannot allocate. Timed iterations are not captured, and neither are those that wait for
    /// the device on their way: those with an empty key, and those of several ranks.
    template <class F>
    void iteration(const graph_key& key, const F& f) {
        const bool is_new = key.empty() || keys_.insert(key).second;
        if (!is_new && !times_.is_sampled() && !peers_)
            graph_.launch(stream_, f);
        else
            f();
        end_iteration();
    }

    /// Several ranks need NCCL. Throws `error` if it is not installed.
    void join(gs::ranks::communicator& ranks) {
        ranks_ = &ranks;
        if (ranks.count() > 1 && !peers_) peers_.emplace(ranks);
    }
    gs::ranks::communicator& ranks() { return *ranks_; }
    template <class T>
    void sum_over_ranks(T* p, std::size_t n) {
        if (peers_) peers_->sum(p, n, stream_);
    }
    void gather(const gs::ranks::shares& shares, std::span<const gs::ranks::shared_array> arrays) {
        if (peers_) peers_->gather(shares, arrays, stream_);
    }
    void exchange(const gs::ranks::windows& windows, std::span<const gs::ranks::window_array> arrays) {
        if (peers_) peers_->exchange(windows, arrays, stream_);
    }

    void sample_times(int every) { times_.sample(every); }
    void pause_times(bool paused) { times_.pause(paused); }
    void begin(stage s) { times_.begin(s); }
    void end_iteration() { times_.end_iteration(); }
    const stage_times& times() { return times_.get(); }

    std::size_t peak_bytes() const { return pool_.peak_bytes(); }
    std::size_t used_bytes() const { return pool_.used_bytes(); }
    std::size_t free_bytes() const { return pool_.free_bytes(); }
    void wait() { check(cudaStreamSynchronize(stream_)); }

  private:
    /// A stream with an owner, so that it is destroyed after the members that use it.
    struct owned_stream {
        cudaStream_t stream{};
        owned_stream() { check(cudaStreamCreate(&stream)); }
        owned_stream(const owned_stream&) = delete;
        owned_stream& operator=(const owned_stream&) = delete;
        ~owned_stream() { cudaStreamDestroy(stream); }
        operator cudaStream_t() const { return stream; }
    };

    static unsigned blocks(std::size_t n, unsigned each) {
        return static_cast<unsigned>((n + each - 1) / each);
    }

    /// Launches a kernel, or does nothing if `blocks` is 0. Precondition: the kernel begins with
    /// `await_kernel_before`.
    template <class... Parameters>
    void launch(void (*kernel)(Parameters...), unsigned blocks, unsigned threads, std::size_t shared_bytes,
                const std::type_identity_t<Parameters>&... arguments) {
        if (blocks == 0) return;
        cudaLaunchAttribute overlap{};
        overlap.id = cudaLaunchAttributeProgrammaticStreamSerialization;
        overlap.val.programmaticStreamSerializationAllowed = 1;
        cudaLaunchConfig_t config{};
        config.gridDim = blocks;
        config.blockDim = threads;
        config.dynamicSmemBytes = shared_bytes;
        config.stream = stream_;
        config.attrs = &overlap;
        config.numAttrs = kernels_await_ ? 1 : 0;
        check(cudaLaunchKernelEx(&config, kernel, arguments...));
    }

    /// Calls f for the number of slices, with the number of buckets and the bytes of a table row in shared
    /// memory: see `detail::few_slices`.
    template <class F>
    static void with_slices(std::size_t items, std::size_t buckets, const F& f) {
        using namespace detail;
        constexpr std::size_t many_items = std::size_t{1} << 17, few_buckets = 4096;
        const auto b = static_cast<unsigned>(buckets);
        const std::size_t row = buckets * sizeof(std::uint32_t);
        if (items >= many_items && buckets <= few_buckets)
            f.template operator()<many_slices, true>(b, row);
        else if (buckets <= shared_buckets)
            f.template operator()<few_slices, true>(b, row);
        else
            f.template operator()<few_slices, false>(b, 0);
    }

    /// Computes `prefix_sum` of a sequence. Allocates scratch memory if it needs more than before.
    template <class Numbers>
    void prefix_sum_of(const Numbers& in, buffer<std::uint64_t>& out, std::size_t n) {
        const auto numbers = thrust::make_transform_iterator(thrust::counting_iterator<std::size_t>(0),
                                                             detail::and_a_zero<Numbers>{in, n});
        const auto scan = [&](void* scratch, std::size_t& bytes) {
            return cub::DeviceScan::ExclusiveScan(scratch, bytes, numbers, out.data(), detail::wide_sum{},
                                                  std::uint64_t{0}, n + 1, stream_);
        };
        std::size_t bytes = 0;
        check(scan(nullptr, bytes));
        scratch_.resize(bytes);
        check(scan(scratch_.data(), bytes));
    }

    gs::ranks::communicator alone_, *ranks_ = &alone_;
    cuda_pool pool_;
    owned_stream stream_, upload_stream_;
    transfer launched_;  ///< marks the launches before an upload
    cuda_times times_;
    cuda_graph graph_;
    std::set<graph_key> keys_;    ///< graph keys of the iterations so far
    bool kernels_await_ = false;  ///< whether the GPU launches a kernel before its predecessor ends
    std::size_t resident_warps_ = 0;
    buffer<std::uint32_t> other_keys_, other_values_, sort_memory_;
    buffer<char> scratch_;
    buffer<std::uint64_t> first_candidate_;  // memory of `place_lists`, with the next two
    buffer<std::uint32_t> table_;
    buffer<unsigned> slices_done_;
    std::optional<cuda_peers> peers_;  ///< the GPUs of the other ranks
};
static_assert(device<cuda>);

}  // namespace gs::device
