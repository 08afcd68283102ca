// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <omp.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>
#include <warpagg/warp/simd.hpp>

#include "../../core/host_memory.hpp"
#include "../device.hpp"
#include "../scratch.hpp"
#include "key_check.hpp"

namespace gs::device {

/// The instruction set that this header is compiled for, as part of the device's name.
#if defined(__AVX512VL__)
inline constexpr const char* instruction_set = ", AVX-512";
#elif defined(__AVX2__)
inline constexpr const char* instruction_set = ", AVX2";
#else
inline constexpr const char* instruction_set = "";
#endif

/// The model of `device` for the CPU. OpenMP threads share the indices or warps of a launch, and
/// device memory is host memory. Each member returns when its work is done. `Warp` is the model of
/// `warp` that warp kernels run on.
template <class Warp>
class basic_cpu {
  public:
    static constexpr bool shares_host_memory = true;
    using warp = Warp;
    /// A narrow warp, because kernels over Gaussians with 32 lanes need more values than registers
    /// exist.
    using narrow_warp = std::conditional_t<Warp::size == 32, warpagg::emulator::narrow_lanes<8>, Warp>;

    template <class T>
    class buffer {
      public:
        void resize(std::size_t n) {
            if (n > capacity_) {
                key_check::allocated();
                memory_.reset();
                memory_ = {static_cast<T*>(::operator new[](n * sizeof(T), line)), release{n * sizeof(T)}};
                used += n * sizeof(T);
                capacity_ = n;
            }
            size_ = n;
        }
        void free_in(memory_place) {
            memory_.reset();
            size_ = capacity_ = 0;
        }
        T* data() const { return memory_.get(); }
        std::size_t size() const { return size_; }

      private:
        static_assert(std::is_trivially_copyable_v<T>);
        static constexpr std::align_val_t line{64};  // a row of lanes lies in one cache line
        struct release {
            std::size_t bytes = 0;
            void operator()(T* p) const {
                ::operator delete[](p, line);
                used -= bytes;
            }
        };
        std::unique_ptr<T[], release> memory_;
        std::size_t size_ = 0, capacity_ = 0;
    };

    template <class T>
    using host_buffer = buffer<T>;

    /// Copies finish at once.
    struct transfer {
        static bool is_done() { return true; }
        static void wait() {}
    };

    basic_cpu() {
#if defined(__SSE__)
        // Flush denormals to zero: x86 is slow with them, and Adam's moments become denormal.
#pragma omp parallel
        _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
    }

    std::string name() const {
        return "cpu, " + std::to_string(omp_get_max_threads()) + " threads" + instruction_set;
    }

    std::size_t resident_warps() const { return 16 * static_cast<std::size_t>(omp_get_max_threads()); }

    template <class F>
    void for_each_index(const gs::ranks::share& part, const F& f) {
        key_check::launched<F>(part.count());
#pragma omp parallel for schedule(static)
        for (std::size_t i = part.first; i < part.last; ++i) f(i);
    }
    template <class F>
    void for_each_index(std::size_t n, const F& f) {
        for_each_index(gs::ranks::share{0, n}, f);
    }
    template <class W = warp, class F>
    void for_each_warp(const gs::ranks::share& part, const F& f) {
        key_check::launched<F>(part.count());
        const std::size_t at_once = std::clamp<std::size_t>(part.count() / resident_warps(), 1, 8);
#pragma omp parallel for schedule(dynamic, at_once)
        for (std::size_t i = part.first; i < part.last; ++i) {
            if constexpr (has_scratch<F, W>) {
                typename F::template scratch<W> scratch;
                f(W{}, static_cast<unsigned>(i), scratch);
            } else {
                f(W{}, static_cast<unsigned>(i));
            }
        }
    }
    template <class W = warp, class F>
    void for_each_warp(std::size_t n, const F& f) {
        for_each_warp<W>(gs::ranks::share{0, n}, f);
    }

    template <class T>
    void zero(T* p, std::size_t n) {
        constexpr std::size_t piece = (std::size_t{1} << 16) / sizeof(T);
        if (n == 0) return;
#pragma omp parallel for schedule(static) if (n > 2 * piece)
        for (std::size_t first = 0; first < n; first += piece)
            std::memset(static_cast<void*>(p + first), 0, std::min(piece, n - first) * sizeof(T));
    }
    template <class T>
    void copy(T* to, const T* from, std::size_t n) {
        std::copy_n(from, n, to);
    }
    template <class T>
    void upload(T* to, const T* from, std::size_t n) {
        std::copy_n(from, n, to);
    }
    template <class T>
    void download(T* to, const T* from, std::size_t n) {
        std::copy_n(from, n, to);
    }

    template <class T>
    void begin_upload(transfer&, T* to, const T* from, std::size_t n) {
        std::copy_n(from, n, to);
    }
    void await(const transfer&) {}
    template <class T>
    void begin_download(transfer&, T* to, const T* from, std::size_t n) {
        std::copy_n(from, n, to);
    }

    void prefix_sum(const buffer<std::uint32_t>& in, buffer<std::uint64_t>& out, std::size_t n) {
        std::uint64_t sum = 0;  // mutate: instances_counted_in_32_bits
        for (std::size_t i = 0; i < n; ++i) {
            out.data()[i] = sum;
            sum += in.data()[i];
        }
        out.data()[n] = sum;
    }

    template <class Range>
    void place_lists(std::size_t n, const items auto& all, std::size_t buckets, std::uint64_t capacity,
                     Range* ranges, std::uint64_t* required) {
        // The items are cut into more slices than threads, because some items have far more
        // candidates than others. Each slice has a row of counts, which become places in the lists, and
        // keeps its instances for `write_lists`.
        const std::size_t slices = slices_of_items();
        places_.resize(slices * buckets);
        totals_.resize(buckets);
        first_.resize(buckets + 1);
        if (found_.size() < slices) found_.resize(slices);
        zero(places_.data(), slices * buckets);
        for_each_slice(buckets, [&](std::vector<instance>& kept, std::uint64_t* counts, std::size_t s) {
            auto found = std::move(kept);  // a local copy avoids false sharing
            found.clear();
            for (std::size_t i = n * s / slices; i < n * (s + 1) / slices; ++i) {
                const auto item = all(i);
                for (std::uint32_t k = 0; k < item.size(); ++k)
                    if (const std::uint32_t bucket = item.bucket(k); bucket != no_bucket) {
                        ++counts[bucket];
                        if (capacity > 0) found.push_back({bucket, item.value});
                    }
            }
            kept = std::move(found);
        });
        for_each_index(buckets, [&](std::size_t b) {
            std::uint64_t total = 0;
            for (std::size_t s = 0; s < slices; ++s)
                total += std::exchange(places_.data()[s * buckets + b], total);
            totals_.data()[b] = static_cast<std::uint32_t>(total);
        });
        prefix_sum(totals_, first_, buckets);
        *required = first_.data()[buckets];
        for_each_index(buckets, [&](std::size_t b) {
            ranges[b] = {static_cast<std::uint32_t>(std::min(first_.data()[b], capacity)),
                         static_cast<std::uint32_t>(std::min(first_.data()[b + 1], capacity))};
        });
    }
    template <class Range>
    void write_lists(std::size_t, const items auto&, std::size_t buckets, std::uint64_t most,
                     std::uint32_t* listed, const Range* ranges) {
        for_each_slice(buckets, [&](const std::vector<instance>& found, std::uint64_t* places, std::size_t) {
            for (const auto& [bucket, value] : found) {
                const std::uint64_t place = ranges[bucket].begin + places[bucket]++;
                if (place < ranges[bucket].end && place < most) listed[place] = value;
            }
        });
    }

    void sort_pairs(buffer<std::uint32_t>& keys, buffer<std::uint32_t>& values, std::size_t n) {
        constexpr int bits = 32, digit_bits = 11;
        other_keys_.resize(keys.size());
        other_values_.resize(values.size());
        for (int shift = 0; shift < bits; shift += digit_bits) {
            sort_by_digit(keys.data(), values.data(), n, shift, std::min(digit_bits, bits - shift));
            std::swap(keys, other_keys_);
            std::swap(values, other_values_);
        }
    }

    /// With several ranks, steps depend on what other ranks did, and no graph can be captured. Steps with
    /// an empty key are not captured either.
    template <class F>
    void iteration(const graph_key& key, const F& f) {
        if (ranks_->count() > 1 || key.empty())
            f();
        else
            key_check_.iteration(key, f);
        end_iteration();
    }

    void join(gs::ranks::communicator& ranks) { ranks_ = &ranks; }
    gs::ranks::communicator& ranks() { return *ranks_; }
    template <class T>
    void sum_over_ranks(T* p, std::size_t n) {
        ranks_->sum(p, n);
    }
    void gather(const gs::ranks::shares& shares, std::span<const gs::ranks::shared_array> arrays) {
        ranks_->gather(shares, arrays);
    }
    void exchange(const gs::ranks::windows& windows, std::span<const gs::ranks::window_array> arrays) {
        ranks_->exchange(windows, arrays);
    }

    void sample_times(int every) {
        sampling_ = every;
        iteration_ = 0;
        times_ = {};
    }
    void pause_times(bool paused) { paused_ = paused; }
    void begin(stage s) {
        if (paused_) return;
        const auto now = clock::now();
        if (running_ != stage::count && iteration_ % sampling_ == 0)
            times_.milliseconds[static_cast<std::size_t>(running_)] +=
                std::chrono::duration<double, std::milli>(now - since_).count();
        running_ = s;
        since_ = now;
    }
    void end_iteration() {
        begin(stage::count);
        if (iteration_++ % sampling_ == 0) ++times_.sampled;
    }
    const stage_times& times() { return times_; }

    std::size_t peak_bytes() const { return 0; }
    std::size_t used_bytes() const { return used; }
    std::size_t free_bytes() const { return available_host_bytes(); }
    void wait() {}

  private:
    static inline std::atomic<std::size_t> used = 0;  ///< size of all buffers
    key_check key_check_;
    using clock = std::chrono::steady_clock;

    static std::size_t slices_of_items() { return 4 * static_cast<std::size_t>(omp_get_max_threads()); }
    /// Calls f(instances, places, s) for each slice s of items.
    template <class F>
    void for_each_slice(std::size_t buckets, const F& f) {
        const std::size_t slices = slices_of_items();
#pragma omp parallel for schedule(dynamic)
        for (std::size_t s = 0; s < slices; ++s) f(found_[s], places_.data() + s * buckets, s);
    }

    /// Runs one pass of a stable radix sort, which counts the digits of each slice and then moves
    /// the pairs.
    void sort_by_digit(const std::uint32_t* keys, const std::uint32_t* values, std::size_t n, int shift,
                       int bits) {
        const std::size_t digits = std::size_t{1} << bits;
        const auto digit = [&](std::uint32_t key) { return key >> shift & (digits - 1); };
        std::uint32_t* to_keys = other_keys_.data();
        std::uint32_t* to_values = other_values_.data();
        // With few keys per slice, summing the slices' histograms would take longer than the sort.
        const std::size_t slices =
            std::clamp<std::size_t>(n / (2 * digits), 1, static_cast<std::size_t>(omp_get_max_threads()));
        histograms_.resize(digits * slices);
        const auto for_each_slice = [&](const auto& f) {
#pragma omp parallel for schedule(static, 1)
            for (std::size_t s = 0; s < slices; ++s)
                f(n * s / slices, n * (s + 1) / slices, histograms_.data() + s * digits);
        };
        for_each_slice([&](std::size_t from, std::size_t to, std::size_t* counts) {
            std::fill_n(counts, digits, std::size_t{0});
            for (std::size_t i = from; i < to; ++i) ++counts[digit(keys[i])];
        });
        // The first position of each digit, and within it of each slice. All threads share this
        // work, because counts that other threads wrote are slow to read.
        starts_.resize(digits);
        for_each_index(digits, [&](std::size_t d) {
            std::size_t sum = 0;
            for (std::size_t s = 0; s < slices; ++s) sum += std::exchange(histograms_[s * digits + d], sum);
            starts_[d] = sum;
        });
        for (std::size_t d = 0, sum = 0; d < digits; ++d) sum += std::exchange(starts_[d], sum);
        for_each_slice([&](std::size_t from, std::size_t to, std::size_t* places) {
            for (std::size_t d = 0; d < digits; ++d) places[d] += starts_[d];
            for (std::size_t i = from; i < to; ++i) {  // mutate: equal_depths_in_any_order
                const std::size_t at = places[digit(keys[i])]++;
                to_keys[at] = keys[i];
                to_values[at] = values[i];
            }
        });
    }

    gs::ranks::communicator alone_;
    gs::ranks::communicator* ranks_ = &alone_;
    buffer<std::uint32_t> other_keys_, other_values_;
    std::vector<std::size_t> histograms_, starts_;
    // Memory of `place_lists`.
    struct instance {
        std::uint32_t bucket, value;
    };
    std::vector<std::vector<instance>> found_;  // by slice
    buffer<std::uint64_t> places_, first_;
    buffer<std::uint32_t> totals_;
    stage_times times_;
    stage running_ = stage::count;
    int sampling_ = 1, iteration_ = 0;
    bool paused_ = false;
    clock::time_point since_;
};

/// The CPU with warps of 8 lanes. A SIMD value of 8 floats fits in one AVX register: see
/// `emulator::basic_lanes`.
using cpu = basic_cpu<warpagg::emulator::narrow_lanes<8>>;
static_assert(device<cpu>);

}  // namespace gs::device
