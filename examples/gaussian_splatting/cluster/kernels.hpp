// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <warpagg/core/compiler.hpp>

namespace gs::cluster {

/// Centroids are stored in groups of this length: value j of centroid c is at (c / 8 * width + j) *
/// 8 + c % 8. So the distances of a point to a group are computed side by side.
inline constexpr std::size_t group = 8;

WARPAGG_HD constexpr std::size_t centroid_index(std::size_t c, std::size_t j, std::size_t width) {
    return (c / group * width + j) * group + c % group;
}

/// A range of points, and the range of groups of centroids among which they choose.
struct segment {
    std::uint32_t first_point, end_point;
    std::uint32_t first_group, end_group;
    std::uint32_t centroids;  ///< the number of centroids in these groups; others are unused
};

/// Copies points of `width` values in another order. One index per value.
template <class T>
struct gather_points {
    const T* from;
    const std::uint32_t* order;
    std::size_t width;
    T* to;

    WARPAGG_HD void operator()(std::size_t i) const { to[i] = from[order[i / width] * width + i % width]; }
};

/// Makes the first points of each segment, which are the heaviest, its first centroids. One index per
/// slot of a centroid.
struct seed_centroids {
    const float* points;
    std::size_t width;
    const segment* segments;
    const std::uint32_t* segment_of_group;
    float* centroids;

    WARPAGG_HD void operator()(std::size_t c) const {
        const segment s = segments[segment_of_group[c / group]];
        const std::size_t k = c - s.first_group * group;
        if (k >= s.centroids) return;
        for (std::size_t j = 0; j < width; ++j)
            centroids[centroid_index(c, j, width)] = points[(s.first_point + k) * width + j];
    }
};

/// Computes half of the squared length of each centroid. Unused slots get a number that no point
/// prefers. One index per slot.
struct half_squares {
    const float* centroids;
    std::size_t width;
    const segment* segments;
    const std::uint32_t* segment_of_group;
    float* result;

    WARPAGG_HD void operator()(std::size_t c) const {
        const segment s = segments[segment_of_group[c / group]];
        float sum = 0;
        for (std::size_t j = 0; j < width; ++j) {
            const float x = centroids[centroid_index(c, j, width)];
            sum += x * x;
        }
        result[c] = c - s.first_group * group < s.centroids ? sum / 2 : 3e38f;
    }
};

/// The distances to a group, side by side. Compilers for the CPU do not vectorize loops over arrays
/// reliably, and nvcc does not know vector types.
#if defined(__CUDACC__)
struct group_values {
    float value[group];

    WARPAGG_HD float operator[](std::size_t k) const { return value[k]; }
};

WARPAGG_HD void load(group_values& to, const float* from) {
    WARPAGG_UNROLL
    for (std::size_t k = 0; k < group; ++k) to.value[k] = from[k];
}
WARPAGG_HD void subtract_product(group_values& from, float factor, const group_values& x) {
    WARPAGG_UNROLL
    for (std::size_t k = 0; k < group; ++k) from.value[k] -= factor * x.value[k];
}
#else
typedef float group_values __attribute__((vector_size(group * sizeof(float))));

inline void load(group_values& to, const float* from) { std::memcpy(&to, from, sizeof to); }
inline void subtract_product(group_values& from, float factor, const group_values& x) { from -= factor * x; }
#endif

/// Finds the nearest centroid of each point: the one with the smallest |c|^2 / 2 - p c. One index per
/// `points_at_once` points, which share the loads of centroids if they are in one segment.
struct assign_points {
    static constexpr std::size_t points_at_once = 8;

    std::size_t count;
    const float* points;
    std::size_t width;
    const float* centroids;
    const float* half_square;
    const segment* segments;
    const std::uint32_t* segment_of_point;
    std::uint32_t* labels;
    std::uint32_t* numbers;  ///< receives the index of the point

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t first = i * points_at_once, last = first + points_at_once - 1;
        if (last < count && segment_of_point[first] == segment_of_point[last]) {
            assign<points_at_once>(first);
        } else {
            for (std::size_t p = first; p <= last && p < count; ++p) assign<1>(p);
        }
    }

  private:
    template <std::size_t Points>
    WARPAGG_HD void assign(std::size_t first) const {
        const segment s = segments[segment_of_point[first]];
        float best[Points];
        std::uint32_t label[Points];
        for (std::size_t p = 0; p < Points; ++p) {
            best[p] = 3.4e38f;
            label[p] = 0;
        }
        for (std::uint32_t g = s.first_group; g < s.end_group; ++g) {
            group_values distance[Points], c;
            load(c, half_square + g * group);
            WARPAGG_UNROLL
            for (std::size_t p = 0; p < Points; ++p) distance[p] = c;
            for (std::size_t j = 0; j < width; ++j) {
                load(c, centroids + (g * width + j) * group);
                WARPAGG_UNROLL
                for (std::size_t p = 0; p < Points; ++p)
                    subtract_product(distance[p], points[(first + p) * width + j], c);
            }
            WARPAGG_UNROLL
            for (std::size_t p = 0; p < Points; ++p) choose(distance[p], g, best[p], label[p]);
        }
        for (std::size_t p = 0; p < Points; ++p) {
            labels[first + p] = label[p];
            numbers[first + p] = static_cast<std::uint32_t>(first + p);
        }
    }

    WARPAGG_HD static void choose(const group_values& distance, std::uint32_t g, float& best,
                                  std::uint32_t& label) {
        WARPAGG_UNROLL
        for (std::size_t k = 0; k < group; ++k)
            if (distance[k] < best) {
                best = distance[k];
                label = static_cast<std::uint32_t>(g * group + k);
            }
    }
};

/// Finds where the points of each centroid begin in their list, which is sorted by label. One index
/// per slot, and one for the end.
struct find_starts {
    const std::uint32_t* labels;
    std::size_t count;  ///< points
    std::uint32_t* starts;

    WARPAGG_HD void operator()(std::size_t c) const {
        std::size_t low = 0, high = count;
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            labels[middle] < c ? low = middle + 1 : high = middle;
        }
        starts[c] = static_cast<std::uint32_t>(low);
    }
};

/// Moves each centroid to the weighted mean of its points, which are added in a fixed order. Centroids
/// without weight stay. One index per slot and value.
struct move_centroids {
    const float* points;
    std::size_t width;
    const float* weights;
    const std::uint32_t* list;  ///< points, sorted by label
    const std::uint32_t* starts;
    float* centroids;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::size_t c = i / width, j = i % width, first = starts[c], end = starts[c + 1];
        float sum = 0, weight = 0;
        for (std::size_t k = first; k < end; ++k) {
            sum += weights[list[k]] * points[list[k] * width + j];
            weight += weights[list[k]];
        }
        if (weight > 0) centroids[centroid_index(c, j, width)] = sum / weight;
    }
};

/// Copies the centroids of some slots, one after the other. One index per value.
struct collect_centroids {
    const float* centroids;
    const std::uint32_t* slots;
    std::size_t width;
    float* to;

    WARPAGG_HD void operator()(std::size_t i) const {
        to[i] = centroids[centroid_index(slots[i / width], i % width, width)];
    }
};

/// Replaces slots by the numbers of their centroids, and restores the original order of the points. One
/// index per point.
struct number_labels {
    const std::uint32_t* labels;
    const std::uint32_t* number_of_slot;
    const std::uint32_t* order;
    std::uint32_t* to;

    WARPAGG_HD void operator()(std::size_t i) const { to[order[i]] = number_of_slot[labels[i]]; }
};

}  // namespace gs::cluster
