// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "image/image.hpp"

namespace gs_test {

/// Images and weights that patterns.py generates with the same bits.
/// @{

/// Returns the number with this index of a random sequence: in [0, 1), a multiple of 2^-24.
inline double uniform(std::size_t index, std::uint32_t seed) {
    std::uint32_t x = static_cast<std::uint32_t>(index) * 0x9e3779b9U + seed;
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return ((x ^ (x >> 16)) >> 8) * 0x1p-24;
}

struct pattern_images {
    std::vector<float> render, target;
    gs::image photo;  ///< tells which pixels are masked; the colors are not those of `target`
};

inline pattern_images make_images(int width, int height) {
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    pattern_images images;
    for (std::size_t i = 0; i < 3 * rows * columns; ++i) {
        const std::size_t channel = i / (rows * columns), row = i / columns % rows, column = i % columns;
        const double square = uniform((channel * 64 + row / 4) * 64 + column / 4, 1);
        images.target.push_back(static_cast<float>(0.75 * square + 0.25 * uniform(i, 2)));
        images.render.push_back(
            static_cast<float>(0.875 * static_cast<double>(images.target[i]) + 0.125 * uniform(i, 3)));
    }
    images.photo = {width, height, std::vector<std::uint8_t>(4 * rows * columns, 255)};
    return images;
}

/// Masks the pixels of `mask` in patterns.py.
inline void mask_pattern(gs::image& photo) {
    for (int row = 0; row < photo.height; ++row)
        for (int column = 0; column < photo.width; ++column)
            if ((row < 4 && column >= 20 && column < 24) || (row == 20 && column == 3))
                photo.mask_pixel(static_cast<std::size_t>(row * photo.width + column));
}

struct pattern_tensor {
    std::string name;
    std::vector<std::size_t> shape;
    std::function<double(std::size_t)> value;

    std::size_t count() const {
        std::size_t product = 1;
        for (const std::size_t extent : shape) product *= extent;
        return product;
    }
};

/// Returns all tensors of LPIPS.
inline std::vector<pattern_tensor> lpips_tensors() {
    const std::vector<std::vector<int>> convolutions{
        {0, 2}, {5, 7}, {10, 12, 14}, {17, 19, 21}, {24, 26, 28}};
    const std::size_t depths[] = {64, 128, 256, 512, 512};
    std::vector<pattern_tensor> tensors;
    std::size_t depth = 3;
    std::uint32_t seed = 100;
    for (std::size_t layer = 0; layer < convolutions.size(); ++layer) {
        const std::size_t to = depths[layer];
        for (const int index : convolutions[layer]) {
            const double bound = std::sqrt(6 / (9 * static_cast<double>(depth)));
            const std::string name = "features." + std::to_string(index);
            tensors.push_back({name + ".weight", {to, depth, 3, 3}, [=](std::size_t i) {
                                   return (2 * uniform(i, seed) - 1) * bound;
                               }});
            tensors.push_back(
                {name + ".bias", {to}, [=](std::size_t i) { return 0.25 * uniform(i, seed + 1) - 0.125; }});
            depth = to;
            seed += 2;
        }
        tensors.push_back({"lin" + std::to_string(layer) + ".model.1.weight",
                           {1, to, 1, 1},
                           [=](std::size_t i) { return uniform(i, seed); }});
        ++seed;
    }
    return tensors;
}
/// @}

/// Writes a safetensors file with the header, whose length comes first, and values.
inline void write_safetensors(const std::filesystem::path& file, const std::string& header,
                              const std::string& values) {
    const std::uint64_t length = header.size();
    std::string start(sizeof length, '\0');
    std::memcpy(start.data(), &length, sizeof length);
    write_file(file, start + header + values);
}

/// Returns the header of a file of weights. `input_range` is an entry of its metadata.
inline nlohmann::json weights_header(const std::vector<pattern_tensor>& tensors,
                                     const std::string& input_range) {
    nlohmann::json header{{"__metadata__", {{"input_range", input_range}}}};
    std::size_t at = 0;
    for (const pattern_tensor& tensor : tensors) {
        const std::size_t end = at + tensor.count() * sizeof(float);
        header[tensor.name] = {{"dtype", "F32"}, {"shape", tensor.shape}, {"data_offsets", {at, end}}};
        at = end;
    }
    return header;
}

/// Writes the weights of patterns.py as a file for --lpips.
inline void write_lpips_weights(const std::filesystem::path& file, const std::string& input_range) {
    const auto tensors = lpips_tensors();
    std::string values;
    for (const pattern_tensor& tensor : tensors)
        for (std::size_t i = 0; i < tensor.count(); ++i) {
            const auto value = static_cast<float>(tensor.value(i));
            char bytes[sizeof value];
            std::memcpy(bytes, &value, sizeof value);
            values.append(bytes, sizeof bytes);
        }
    write_safetensors(file, weights_header(tensors, input_range).dump(), values);
}

/// Returns the values that scikit-image or PyTorch compute for a metric, by case.
inline nlohmann::json reference_metrics(const std::string& metric) {
    const std::string file = WARPAGG_SOURCE_DIR "/tests/gaussian_splatting/evaluation/reference_metrics.json";
    return nlohmann::json::parse(read_file(file)).at(metric);
}

}  // namespace gs_test
