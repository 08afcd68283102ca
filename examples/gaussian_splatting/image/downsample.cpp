// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "../core/large_memory.hpp"
#include "image.hpp"

namespace gs {
namespace {

/// The input pixels that one output pixel covers on one axis. Lengths are whole numbers in units of
/// 1/output of an input pixel. The lengths of one output pixel sum to `input`.
struct coverage {
    std::size_t first;
    std::vector<std::uint32_t> lengths;
};

std::vector<coverage> coverages(std::size_t input, std::size_t output) {
    std::vector<coverage> all(output);
    for (std::size_t o = 0; o < output; ++o) {
        const std::size_t begin = o * input, end = begin + input;
        all[o].first = begin / output;
        for (std::size_t i = all[o].first; i * output < end; ++i) {
            const std::size_t length = std::min(end, (i + 1) * output) - std::max(begin, i * output);
            all[o].lengths.push_back(static_cast<std::uint32_t>(length));
        }
    }
    return all;
}

/// Sums the rows that one output row covers. The sums are at most 255 * input, which fits.
void sum_rows(const image& source, const coverage& line, std::vector<std::uint32_t>& sums) {
    std::fill(sums.begin(), sums.end(), 0U);
    for (std::size_t i = 0; i < line.lengths.size(); ++i) {
        const std::uint8_t* row = source.rgba.data() + sums.size() * (line.first + i);
        const std::uint32_t length = line.lengths[i];
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += length * row[k];
    }
}

image average(const image& source, int width, int height) {
    const auto source_width = static_cast<std::size_t>(source.width);
    const auto source_height = static_cast<std::size_t>(source.height);
    const auto columns = coverages(source_width, static_cast<std::size_t>(width));
    const auto lines = coverages(source_height, static_cast<std::size_t>(height));
    const std::uint64_t area = std::uint64_t{source_width} * source_height;

    image result{width, height, {}};
    resize_for_image(result.rgba, 4 * columns.size() * lines.size());
    std::uint8_t* to = result.rgba.data();
    std::vector<std::uint32_t> rows(4 * source_width);
    for (const coverage& line : lines) {
        sum_rows(source, line, rows);
        for (const coverage& column : columns) {
            std::array<std::uint64_t, 4> sums{};
            for (std::size_t i = 0; i < column.lengths.size(); ++i)
                for (std::size_t channel = 0; channel < 4; ++channel)
                    sums[channel] +=
                        std::uint64_t{column.lengths[i]} * rows[4 * (column.first + i) + channel];
            for (const std::uint64_t sum : sums) *to++ = static_cast<std::uint8_t>((sum + area / 2) / area);
        }
    }
    return result;
}

/// Averages the pixels that are not masked: averages with zeros in place of masked pixels, and
/// divides by the share of the other pixels.
image masked_average(const image& source, int width, int height) {
    image kept = source, share = source;
    for (std::size_t i = 0; i < source.rgba.size() / 4; ++i) {
        const bool out = source.is_masked(i);
        for (std::size_t channel = 0; channel < 4; ++channel) {
            if (out) kept.rgba[4 * i + channel] = 0;
            share.rgba[4 * i + channel] = out ? 0 : 255;
        }
    }
    image result = average(kept, width, height);
    share = average(share, width, height);
    for (std::size_t i = 0; i < result.rgba.size(); i += 4) {
        const unsigned of = share.rgba[i];
        if (of < 128) {
            result.mask_pixel(i / 4);
        } else {
            for (std::size_t channel = 0; channel < 4; ++channel)
                result.rgba[i + channel] = static_cast<std::uint8_t>(
                    std::min((255u * result.rgba[i + channel] + of / 2) / of, 255u));
        }
    }
    return result;
}

}  // namespace

image downsample(const image& source, int width, int height) {
    if (width == source.width && height == source.height) return source;
    image result = (source.has_mask ? masked_average : average)(source, width, height);
    result.has_alpha = result.has_transparent_pixel();
    return result;
}

}  // namespace gs
