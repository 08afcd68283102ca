// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "lpips.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "../../core/error.hpp"
#include "../../core/parallel.hpp"
#include "../../core/sanitize_for_message.hpp"
#include "safetensors.hpp"

namespace gs::evaluate {

namespace {

/// The stages of VGG16: the number of output channels, and the indices of the convolutions in
/// torchvision's list of layers.
struct stage_shape {
    std::size_t depth;
    std::vector<int> convolutions;
};
const std::array<stage_shape, lpips_network::layer_count> shapes{
    {{64, {0, 2}}, {128, {5, 7}}, {256, {10, 12, 14}}, {512, {17, 19, 21}}, {512, {24, 26, 28}}}};

/// Returns the value of black in the network's input.
int read_black(const safetensors_file& file, const std::filesystem::path& path) {
    const std::string range = file.metadata("input_range");
    if (range == "-1,1") return -1;
    if (range == "0,1") return 0;
    throw error(path.string() + " has the input_range \"" + sanitize_for_message(range) +
                "\" in its metadata instead of \"-1,1\" or \"0,1\": create the file with "
                "scripts/convert_lpips_weights.py");
}

double norm(const float* values, std::size_t count) {
    double squares = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double value = static_cast<double>(values[i]);
        squares += value * value;
    }
    return std::sqrt(squares);
}

/// Returns the squared distance of the features of two pixels, each scaled to length 1.
double pixel_distance(const float* one, const float* other, const std::vector<float>& linear) {
    constexpr double epsilon = 1e-10;
    const double scale_one = 1 / (norm(one, linear.size()) + epsilon);
    const double scale_other = 1 / (norm(other, linear.size()) + epsilon);
    double sum = 0;
    for (std::size_t i = 0; i < linear.size(); ++i) {
        const double difference =
            static_cast<double>(one[i]) * scale_one - static_cast<double>(other[i]) * scale_other;
        sum += static_cast<double>(linear[i]) * difference * difference;
    }
    return sum;
}

/// Returns the mean of `pixel_distance`.
double map_distance(const feature_map& one, const feature_map& other, const std::vector<float>& linear) {
    std::vector<double> rows(one.height());
    for_each_in_parallel(rows.size(), [&](std::size_t row) {
        for (std::size_t column = 0; column < one.width(); ++column)
            rows[row] += pixel_distance(one.at(column, row), other.at(column, row), linear);
    });
    return std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(one.width() * one.height());
}

}  // namespace

lpips_network::lpips_network(const std::filesystem::path& weights) {
    safetensors_file file(weights);
    black_ = read_black(file, weights);
    std::size_t depth = 3;
    for (const stage_shape& shape : shapes) {
        stage& next = stages_.emplace_back();
        for (const int layer : shape.convolutions) {
            const std::string name = "features." + std::to_string(layer);
            const auto values = file.read(name + ".weight", {shape.depth, depth, 3, 3});
            next.convolutions.emplace_back(depth, shape.depth, values,
                                           file.read(name + ".bias", {shape.depth}));
            depth = shape.depth;
        }
        next.linear =
            file.read("lin" + std::to_string(stages_.size() - 1) + ".model.1.weight", {1, shape.depth, 1, 1});
    }
}

/// Normalizes the values of the channels as the authors of LPIPS do.
feature_map lpips_network::input(const std::vector<float>& planes, std::size_t width,
                                 std::size_t height) const {
    constexpr float shift[] = {-0.030F, -0.088F, -0.188F}, scale[] = {0.458F, 0.448F, 0.450F};
    const auto black = static_cast<float>(black_);
    feature_map map(width, height, 3);
    for (std::size_t row = 0; row < height; ++row)
        for (std::size_t column = 0; column < width; ++column)
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const float value = planes[(channel * height + row) * width + column];
                map.at(column, row)[channel] =
                    (black + (1 - black) * value - shift[channel]) / scale[channel];
            }
    map.clear_frame();
    return map;
}

std::optional<double> lpips_network::distance(const std::vector<float>& one, const std::vector<float>& other,
                                              int width, int height) const {
    if (std::min(width, height) < least_size) return std::nullopt;
    const auto layers = layer_distances(one, other, width, height);
    return std::accumulate(layers.begin(), layers.end(), 0.0);
}

std::array<double, lpips_network::layer_count> lpips_network::layer_distances(const std::vector<float>& one,
                                                                              const std::vector<float>& other,
                                                                              int width, int height) const {
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    std::array<feature_map, 2> maps{input(one, columns, rows), input(other, columns, rows)};
    std::array<double, layer_count> distances{};
    for (std::size_t layer = 0; layer < layer_count; ++layer) {
        for (feature_map& map : maps) {
            if (layer > 0) map = max_pool(map);
            for (const convolution& convolve : stages_[layer].convolutions) map = convolve(map);
        }
        distances[layer] = map_distance(maps[0], maps[1], stages_[layer].linear);
    }
    return distances;
}

}  // namespace gs::evaluate
