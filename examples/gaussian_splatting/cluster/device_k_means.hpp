// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "../device/device.hpp"
#include "k_means.hpp"
#include "kernels.hpp"

namespace gs::cluster {

/// `k_means_function` on any device.
template <device::device Device>
class device_k_means {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    clustering run(const std::vector<float>& points, std::size_t width, const std::vector<float>& weights,
                   std::size_t most) {
        width_ = width;
        const std::size_t count = points.size() / width;
        if (count == 0) return {};
        upload(all_points_, points);
        upload(all_weights_, weights);
        const std::vector<std::uint32_t> heaviest_first = sorted_by_weight(weights);
        const std::size_t k = std::min(most, count);
        const std::vector<std::uint32_t> coarse = coarse_labels(heaviest_first, k);

        const std::vector<std::uint32_t> order = sorted_by_label(heaviest_first);
        gather(order);
        const std::vector<segment> segments = fine_segments(coarse, k);
        fit(segments, fine_iterations);
        return result(segments, count);
    }

  private:
    static constexpr std::size_t sample_size = 1 << 16;
    static constexpr int coarse_iterations = 5, fine_iterations = 4;

    template <class T>
    void upload(buffer<T>& to, const std::vector<T>& from) {
        to.resize(from.size());
        device_.upload(to.data(), from.data(), from.size());
        device_.wait();
    }

    template <class T>
    std::vector<T> downloaded(const buffer<T>& from, std::size_t count) {
        std::vector<T> to(count);
        device_.download(to.data(), from.data(), count);
        return to;
    }

    /// Copies all points, or some, to `points_` and `weights_` in this order.
    void gather(const std::vector<std::uint32_t>& order) {
        upload(order_, order);
        points_.resize(order.size() * width_);
        weights_.resize(order.size());
        device_.for_each_index(order.size() * width_,
                               gather_points{all_points_.data(), order_.data(), width_, points_.data()});
        device_.for_each_index(order.size(),
                               gather_points{all_weights_.data(), order_.data(), 1, weights_.data()});
    }

    /// Returns the indices of the points, heaviest first.
    std::vector<std::uint32_t> sorted_by_weight(const std::vector<float>& weights) {
        std::vector<std::uint32_t> keys(weights.size()), order(weights.size());
        std::ranges::transform(weights, keys.begin(),
                               [](float w) { return ~std::bit_cast<std::uint32_t>(w); });
        std::iota(order.begin(), order.end(), 0U);
        upload(keys_, keys);
        upload(list_, order);
        return sorted_list(order.size());
    }

    /// Clusters a sample coarsely, and returns the coarse cluster of each point.
    std::vector<std::uint32_t> coarse_labels(const std::vector<std::uint32_t>& heaviest_first,
                                             std::size_t k) {
        const std::size_t count = heaviest_first.size();
        const auto clusters = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(k))));
        std::vector<std::uint32_t> sample(std::min(count, sample_size));
        for (std::size_t i = 0; i < sample.size(); ++i) sample[i] = heaviest_first[i * count / sample.size()];
        gather(sample);
        const std::vector<segment> one{
            {0, static_cast<std::uint32_t>(sample.size()), 0, groups_for(clusters), clusters}};
        fit(one, coarse_iterations);
        resize_labels(count);
        device_.zero(segment_of_point_.data(), count);
        assign(all_points_.data(), count);
        return downloaded(labels_, count);
    }

    static std::uint32_t groups_for(std::size_t centroids) {
        return static_cast<std::uint32_t>((centroids + group - 1) / group);
    }

    /// Returns the indices of the points, sorted by `labels_`. Points of one label stay in this order.
    std::vector<std::uint32_t> sorted_by_label(const std::vector<std::uint32_t>& order) {
        upload(list_, order);
        keys_.resize(order.size());
        device_.for_each_index(order.size(), gather_points{labels_.data(), list_.data(), 1, keys_.data()});
        return sorted_list(order.size());
    }

    /// Returns `list_`, sorted by `keys_`.
    std::vector<std::uint32_t> sorted_list(std::size_t count) {
        device_.sort_pairs(keys_, list_, count);
        return downloaded(list_, count);
    }

    /// Distributes `k` centroids to the coarse clusters in proportion to their points. Each gets at
    /// least one. Rounds to whole groups where possible, because a group takes the same time with
    /// any number of centroids.
    static std::vector<segment> fine_segments(const std::vector<std::uint32_t>& coarse, std::size_t k) {
        std::vector<std::uint32_t> sizes(*std::ranges::max_element(coarse) + 1);
        for (const std::uint32_t label : coarse) ++sizes[label];
        std::erase(sizes, 0U);
        std::vector<segment> segments;
        std::uint32_t point = 0, first_group = 0;
        // The first centroid of each cluster is not part of what is distributed.
        const std::size_t rest_of_k = k - sizes.size(), rest_of_points = coarse.size() - sizes.size();
        std::size_t points_before = 0, given = 0;
        for (const std::uint32_t size : sizes) {
            points_before += size - 1;
            const std::size_t share =
                rest_of_points == 0 ? 0 : points_before * rest_of_k / rest_of_points - given;
            given += share;
            const auto centroids = static_cast<std::uint32_t>(1 + share);
            segments.push_back(
                {point, point + size, first_group, first_group + groups_for(centroids), centroids});
            point += size;
            first_group = segments.back().end_group;
        }
        return segments;
    }

    void resize_labels(std::size_t count) {
        segment_of_point_.resize(count);
        labels_.resize(count);
        list_.resize(count);
    }

    /// Clusters `points_` within the segments: sets `centroids_` and `labels_`.
    void fit(const std::vector<segment>& segments, int iterations) {
        const std::size_t count = segments.back().end_point, groups = segments.back().end_group;
        std::vector<std::uint32_t> of_point(count), of_group(groups);
        for (std::size_t s = 0; s < segments.size(); ++s) {
            std::fill(of_point.begin() + segments[s].first_point, of_point.begin() + segments[s].end_point,
                      static_cast<std::uint32_t>(s));
            std::fill(of_group.begin() + segments[s].first_group, of_group.begin() + segments[s].end_group,
                      static_cast<std::uint32_t>(s));
        }
        resize_labels(count);
        upload(segments_, segments);
        upload(segment_of_point_, of_point);
        upload(segment_of_group_, of_group);
        slots_ = groups * group;
        centroids_.resize(slots_ * width_);
        half_squares_.resize(slots_);
        starts_.resize(slots_ + 1);
        device_.zero(centroids_.data(), slots_ * width_);
        device_.for_each_index(slots_, seed_centroids{points_.data(), width_, segments_.data(),
                                                      segment_of_group_.data(), centroids_.data()});
        assign(points_.data(), count);
        for (int i = 0; i < iterations; ++i) {
            device_.sort_pairs(labels_, list_, count);
            device_.for_each_index(slots_ + 1, find_starts{labels_.data(), count, starts_.data()});
            device_.for_each_index(slots_ * width_,
                                   move_centroids{points_.data(), width_, weights_.data(), list_.data(),
                                                  starts_.data(), centroids_.data()});
            assign(points_.data(), count);
        }
    }

    void assign(const float* points, std::size_t count) {
        device_.for_each_index(slots_, half_squares{centroids_.data(), width_, segments_.data(),
                                                    segment_of_group_.data(), half_squares_.data()});
        constexpr std::size_t at_once = assign_points::points_at_once;
        device_.for_each_index(
            (count + at_once - 1) / at_once,
            assign_points{count, points, width_, centroids_.data(), half_squares_.data(), segments_.data(),
                          segment_of_point_.data(), labels_.data(), list_.data()});
    }

    /// Downloads the clustering, without the unused slots, in the original order of the points.
    clustering result(const std::vector<segment>& segments, std::size_t count) {
        std::vector<std::uint32_t> number_of_slot(slots_), used;
        for (const segment& s : segments)
            for (std::uint32_t i = 0; i < s.centroids; ++i) {
                const auto slot = static_cast<std::uint32_t>(s.first_group * group + i);
                number_of_slot[slot] = static_cast<std::uint32_t>(used.size());
                used.push_back(slot);
            }
        upload(starts_, used);
        points_.resize(used.size() * width_);
        device_.for_each_index(used.size() * width_,
                               collect_centroids{centroids_.data(), starts_.data(), width_, points_.data()});
        upload(keys_, number_of_slot);
        device_.for_each_index(count,
                               number_labels{labels_.data(), keys_.data(), order_.data(), list_.data()});
        return {downloaded(points_, used.size() * width_), downloaded(list_, count)};
    }

    Device device_;
    std::size_t width_ = 0, slots_ = 0;
    buffer<float> all_points_, all_weights_;  ///< in the order of the caller
    buffer<float> points_, weights_;          ///< those that are clustered, segment by segment
    buffer<float> centroids_, half_squares_;
    buffer<segment> segments_;
    buffer<std::uint32_t> order_, segment_of_point_, segment_of_group_, labels_, keys_, list_, starts_;
};

}  // namespace gs::cluster
