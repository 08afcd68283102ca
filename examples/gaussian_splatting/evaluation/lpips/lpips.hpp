// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "feature_map.hpp"

namespace gs::evaluate {

/// The perceptual metric LPIPS (Zhang et al. 2018), version 0.1 with the network VGG16.
class lpips_network {
  public:
    static constexpr std::size_t layer_count = 5;
    /// The smallest width and height of images, which the network halves four times.
    static constexpr int least_size = 16;

    /// Reads the weights from a file of scripts/convert_lpips_weights.py. Throws `error` if the
    /// file cannot be read or has other tensors.
    explicit lpips_network(const std::filesystem::path& weights);

    /// Returns the number that black has in the network's input; white is 1. The file of weights
    /// specifies it: -1 or 0.
    int black() const { return black_; }

    /// Returns the distance of two images, which have three planes of values in [0, 1]. Returns
    /// nothing if they are smaller than `least_size`.
    ///
    /// Takes about 1.2 million floating-point operations per pixel, on all threads, and at most
    /// 800 bytes per pixel.
    std::optional<double> distance(const std::vector<float>& one, const std::vector<float>& other, int width,
                                   int height) const;

    /// Returns the parts of the distance that come from the layers relu1_2, relu2_2, relu3_3,
    /// relu4_3 and relu5_3. Precondition: the images have at least `least_size` rows and columns.
    std::array<double, layer_count> layer_distances(const std::vector<float>& one,
                                                    const std::vector<float>& other, int width,
                                                    int height) const;

  private:
    /// The layers of the network up to one that is compared.
    struct stage {
        std::vector<convolution> convolutions;
        std::vector<float> linear;  ///< weights of the channels
    };

    feature_map input(const std::vector<float>& planes, std::size_t width, std::size_t height) const;

    int black_ = -1;
    std::vector<stage> stages_;
};

}  // namespace gs::evaluate
