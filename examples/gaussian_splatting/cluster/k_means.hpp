// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gs::cluster {

/// Points of one width, replaced by few centroids.
struct clustering {
    std::vector<float> centroids;       ///< `width` floats each
    std::vector<std::uint32_t> labels;  ///< the centroid of each point
};

/// Clusters points by weighted k-means: reduces the sum of weight times squared distance. It has two
/// levels: about sqrt(k) coarse clusters of all points, and within each of them a share of the
/// centroids in proportion to its points. The distance of a point to its centroid is therefore not
/// always the smallest one, but the time grows with sqrt(k). The heaviest points of a cluster, and the
/// first ones of equal weight, are its first centroids.
///
/// `points` has `width` floats per point, all finite and below 10^9 in magnitude. `weights` has one
/// number from 0 to 1 per point. A point of weight 0 moves no centroid, and a centroid with no other
/// points keeps its place. Returns at most `most` centroids, at least one for each point if there are
/// no more points. The result is the same in every run on the same device. Preconditions: width and
/// `most` are not 0; there are less than 2^30 points.
using k_means_function = clustering (*)(const std::vector<float>& points, std::size_t width,
                                        const std::vector<float>& weights, std::size_t most);

/// Clusters on the CPU with all threads.
clustering k_means_on_cpu(const std::vector<float>& points, std::size_t width,
                          const std::vector<float>& weights, std::size_t most);

/// Clusters on the GPU. Throws `error` if the program was built without CUDA.
clustering k_means_on_cuda(const std::vector<float>& points, std::size_t width,
                           const std::vector<float>& weights, std::size_t most);

}  // namespace gs::cluster
