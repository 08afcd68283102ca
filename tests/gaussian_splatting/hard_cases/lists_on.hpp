// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>

#include "backend.hpp"
#include "lab/accumulator_set.hpp"
#include "memory_on.hpp"
#include "render/blend/blend_backward.hpp"
#include "render/blend/blend_forward.hpp"
#include "render/gradients/gradient_sums.hpp"
#include "render/tiles/bin.hpp"

namespace hard_cases {

/// Sums 32 values, or one, into one address.
template <class Real, class Policy>
struct sum_values {
    using policy = Policy;
    const Real* values;
    unsigned count;
    gs::raster::sum_in_memory<Real, Policy>* sums;
    Policy how;

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        const auto place = w.lane() + index * W::size;
        const warpagg::mask_t<W> active = place < count;
        const warpagg::value_t<W, Real> one[1] = {w.load(values, place, active)};
        warpagg::warp_reduce_atomic(w, sums, one, active, how);
    }
};

/// Items that are given by their buckets, one's after the other's.
struct given_items {
    const std::uint64_t* first;
    const std::uint32_t* buckets;

    struct item {
        const std::uint32_t* mine;
        std::uint32_t count, value;

        WARPAGG_HD std::uint32_t size() const { return count; }
        WARPAGG_HD std::uint32_t bucket(std::uint32_t k) const { return mine[k]; }
    };
    WARPAGG_HD item operator()(std::size_t i) const {
        return {buckets + first[i], static_cast<std::uint32_t>(first[i + 1] - first[i]),
                static_cast<std::uint32_t>(i)};
    }
};

/// The operations of a backend on splats and numbers.
template <class Device, class Real>
class lists_on {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using memory = memory_on<Device, Real>;

  public:
    static blend_result blend(const blend_case& q) {
        using namespace gs::raster;
        Device device;
        memory on(device);
        std::vector<splat<Real>> made;
        for (const flat_splat& s : q.splats) made.push_back(splat_of(s));
        const auto across = static_cast<unsigned>((q.width + tile_size - 1) / tile_size);
        const auto down = static_cast<unsigned>((q.height + tile_size - 1) / tile_size);
        std::vector<std::uint32_t> order;
        std::vector<tile_range> tiles(across * down);
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            tiles[t].begin = static_cast<std::uint32_t>(order.size());
            if (!q.lists.empty())
                order.insert(order.end(), q.lists[t].begin(), q.lists[t].end());
            else
                for (std::uint32_t i = 0; i < made.size(); ++i) order.push_back(i);
            tiles[t].end = static_cast<std::uint32_t>(order.size());
        }

        buffer<splat<Real>> splats;
        buffer<std::uint32_t> gaussian_of, last, tile_of_segment, class_counts, ordered_tiles;
        buffer<tile_range> ranges;
        buffer<Real> render, transmittance, checkpoints, gradient;
        buffer<unsigned long long> pairs;
        on.put_as_they_are(splats, made);
        on.put_as_they_are(gaussian_of, order);
        on.put_as_they_are(ranges, tiles);
        const auto pixels = static_cast<std::size_t>(q.width) * static_cast<std::size_t>(q.height);
        render.resize(3 * pixels);
        transmittance.resize(pixels);
        last.resize(pixels);
        pairs.resize(1);
        device.zero(pairs.data(), 1);
        const vec3<Real> background(q.background[0], q.background[1], q.background[2]);
        using warp = typename Device::warp;
        using shape = cut_for<warp>;
        const std::size_t segments = most_segments<shape>(tiles.size(), order.size());
        checkpoints.resize(segments * checkpoint_values);
        tile_of_segment.resize(segments);
        device.for_each_index(segments,
                              number_segments<shape>{ranges.data(), static_cast<std::uint32_t>(tiles.size()),
                                                     tile_of_segment.data()});
        const tile_lists<Real> lists{splats.data(), gaussian_of.data(), ranges.data(), across, q.width,
                                     q.height};
        class_counts.resize(tile_order::classes);
        device.zero(class_counts.data(), class_counts.size());
        ordered_tiles.resize(tile_order::classes * tiles.size());
        const tile_order in_order{class_counts.data(), ordered_tiles.data(),
                                  static_cast<std::uint32_t>(tiles.size())};
        device.for_each_index(tiles.size(), order_tiles{ranges.data(), in_order});
        const blend_forward<Real, shape> forward{
            lists,       in_order,           background,  render.data(), transmittance.data(),
            last.data(), checkpoints.data(), pairs.data()};
        device.for_each_warp(forward.template warps<warp>(tiles.size()), forward);
        blend_result a;
        a.render = on.get(render.data(), 3 * pixels);
        a.transmittance = on.get(transmittance.data(), pixels);
        a.last = on.get_as_they_are(last.data(), pixels);
        if (q.gradient.empty()) return a;

        on.put(gradient, q.gradient);
        gradient_sums<Device, Real> sums(device);
        std::vector<double> records;
        gs::lab::lab_accumulators::with_kernel<Real, shape>(q.how, [&](auto backward) {
            backward.lists = lists;
            backward.view = {background,  render.data(),      transmittance.data(),
                             last.data(), checkpoints.data(), gradient.data()};
            backward.tile_of_segment = tile_of_segment.data();
            sums.begin(backward, made.size(), largest_of(q.gradient),
                       backward.template warps_of_sum<warp>(tiles.size()));
            device.for_each_warp(backward.template warps<warp>(tiles.size(), segments), backward);
            const auto& rounded = sums.end(backward);
            records = on.get(rounded.data(), rounded.size());
        });
        static_assert(sum_count == 9);
        a.sums.resize(made.size());
        for (std::size_t i = 0; i < made.size(); ++i)
            std::copy_n(records.data() + i * record_stride, 9, a.sums[i].data());
        return a;
    }

    static std::vector<std::uint64_t> prefix_sum(const std::vector<std::uint32_t>& values) {
        Device device;
        memory on(device);
        buffer<std::uint32_t> in;
        buffer<std::uint64_t> out;
        on.put_as_they_are(in, values);
        out.resize(values.size() + 1);
        device.prefix_sum(in, out, values.size());
        return on.get_as_they_are(out.data(), out.size());
    }

    static std::vector<std::uint32_t> sort(const std::vector<std::uint32_t>& keys) {
        Device device;
        memory on(device);
        std::vector<std::uint32_t> numbers(keys.size());
        std::iota(numbers.begin(), numbers.end(), 0u);
        buffer<std::uint32_t> k, v;
        on.put_as_they_are(k, keys);
        on.put_as_they_are(v, numbers);
        device.sort_pairs(k, v, keys.size());
        const std::vector<std::uint32_t> sorted = on.get_as_they_are(k.data(), keys.size());
        if (!std::ranges::is_sorted(sorted)) return {};
        return on.get_as_they_are(v.data(), keys.size());
    }

    static bucket_lists distribute(const std::vector<std::vector<std::uint32_t>>& items, std::size_t buckets,
                                   std::uint64_t capacity, std::uint32_t moved) {
        Device device;
        memory on(device);
        std::vector<std::uint64_t> first{0};
        std::vector<std::uint32_t> all;
        for (const auto& item : items) {
            all.insert(all.end(), item.begin(), item.end());
            first.push_back(all.size());
        }
        buffer<std::uint64_t> first_on, required;
        buffer<std::uint32_t> all_on, listed;
        buffer<gs::raster::tile_range> ranges;
        on.put_as_they_are(first_on, first);
        on.put_as_they_are(all_on, all);
        required.resize(1);
        listed.resize(capacity + moved);
        ranges.resize(buckets);
        const given_items given{first_on.data(), all_on.data()};
        device.place_lists(items.size(), given, buckets, capacity, ranges.data(), required.data());
        auto moved_ranges = on.get_as_they_are(ranges.data(), buckets);
        for (gs::raster::tile_range& r : moved_ranges) r = {r.begin + moved, r.end + moved};
        on.put_as_they_are(ranges, moved_ranges);
        device.write_lists(items.size(), given, buckets, capacity + moved, listed.data(), ranges.data());
        const auto values = on.get_as_they_are(listed.data(), capacity + moved);
        bucket_lists found{{}, on.get_as_they_are(required.data(), 1)[0]};
        for (const gs::raster::tile_range& r : moved_ranges)
            found.items.emplace_back(values.begin() + r.begin, values.begin() + r.end);
        return found;
    }

    static double sum(const std::vector<double>& values, accumulator how) {
        Device device;
        memory on(device);
        buffer<Real> in;
        on.put(in, values);
        gs::raster::gradient_sums<Device, Real> sums(device);
        double sum = 0;
        constexpr std::size_t lanes = Device::warp::size;
        using shape = gs::raster::cut_for<typename Device::warp>;
        gs::lab::lab_accumulators::with_kernel<Real, shape>(how, [&](auto kernel) {
            sum_values<Real, typename decltype(kernel)::policy> adds{
                in.data(), static_cast<unsigned>(values.size()), nullptr, {}};
            const std::size_t warps = (values.size() + lanes - 1) / lanes;
            sums.begin(adds, 1, largest_of(values), warps);
            device.for_each_warp(warps, adds);
            sum = on.get(sums.end(adds).data(), 1)[0];
        });
        return sum;
    }

  private:
    static gs::raster::splat<Real> splat_of(const flat_splat& s) {
        const auto vector = [](const std::array<double, 3>& v) {
            return glm::vec<3, Real>(glm::dvec3(v[0], v[1], v[2]));
        };
        const gs::raster::ellipse<Real> shape(vector(s.across), vector(s.down));
        gs::raster::splat<Real> made{};
        made.x = static_cast<Real>(s.x);
        made.y = static_cast<Real>(s.y);
        made.log2_opacity = static_cast<Real>(std::log2(s.opacity));
        made.cutoff = static_cast<Real>(std::log2(s.opacity * 255));
        made.p = shape.p;
        made.q = shape.q;
        made.r = shape.r;
        made.dx_per_dy = shape.dx_per_dy;
        made.dy_per_dx = shape.dy_per_dx;
        made.red = static_cast<Real>(s.color[0]);
        made.green = static_cast<Real>(s.color[1]);
        made.blue = static_cast<Real>(s.color[2]);
        return made;
    }
};

}  // namespace hard_cases
