// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "depth_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "../core/error.hpp"
#include "image.hpp"

namespace gs {
namespace {

/// The pixels on a side of `input` pixels that output pixel o covers, and the covered length of
/// each one, when the side is scaled to `output` pixels.
struct covered {
    std::size_t first;
    std::vector<double> lengths;

    covered(int o, int input, int output) {
        const double step = static_cast<double>(input) / output;
        const double begin = o * step, end = std::min(begin + step, static_cast<double>(input));
        first = static_cast<std::size_t>(begin);
        for (double at = begin; at < end; at = std::floor(at) + 1)
            lengths.push_back(std::min(end, std::floor(at) + 1) - at);
    }
};

/// Replaces depths by inverse depths. The nearest one becomes the largest value.
void invert(std::vector<std::uint16_t>& values) {
    constexpr double largest = 65535;
    double nearest = largest;
    for (const std::uint16_t value : values)
        if (value > 0) nearest = std::min<double>(nearest, value);
    for (std::uint16_t& value : values)
        if (value > 0) value = static_cast<std::uint16_t>(std::lround(largest * nearest / value));
}

}  // namespace

depth_map read_depth_map(const std::filesystem::path& file, int width, int height, depth_values values) {
    depth_map map;
    try {
        map.values = read_gray_png(file, map.width, map.height);
    } catch (const error& problem) {
        throw error(std::string(problem.what()) + "; --effects auto,-depth trains without depth maps");
    }
    const double x = static_cast<double>(map.width) / width, y = static_cast<double>(map.height) / height;
    if (std::abs(x / y - 1) > 0.03)
        throw error("the depth map " + file.string() + " is of another shape than its photo: it has " +
                    std::to_string(map.width) + "x" + std::to_string(map.height) + " pixels, the photo " +
                    std::to_string(width) + "x" + std::to_string(height));
    if (values == depth_values::depth) invert(map.values);
    return resized(map, width, height);
}

depth_map resized(const depth_map& source, int width, int height) {
    if (!source.is_there() || (width == source.width && height == source.height)) return source;
    std::vector<covered> columns;
    for (int x = 0; x < width; ++x) columns.emplace_back(x, source.width, width);
    depth_map result{width, height, {}};
    for (int y = 0; y < height; ++y) {
        const covered lines(y, source.height, height);
        for (const covered& column : columns) {
            double sum = 0, known = 0, all = 0;
            for (std::size_t j = 0; j < lines.lengths.size(); ++j)
                for (std::size_t i = 0; i < column.lengths.size(); ++i) {
                    const std::size_t row = (lines.first + j) * static_cast<std::size_t>(source.width);
                    const std::uint16_t value = source.values[row + column.first + i];
                    const double area = lines.lengths[j] * column.lengths[i];
                    all += area;
                    if (value == 0) continue;
                    known += area;
                    sum += area * value;
                }
            result.values.push_back(2 * known < all ? std::uint16_t{0}
                                                    : static_cast<std::uint16_t>(std::lround(sum / known)));
        }
    }
    return result;
}

}  // namespace gs
