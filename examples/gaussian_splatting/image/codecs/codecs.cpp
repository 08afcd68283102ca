// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "../../core/enumerated.hpp"
#include "codec.hpp"

namespace gs {

std::span<const image_codec* const> all_image_codecs() {
    static constexpr const image_codec* all[] = {&png_codec, &jpeg_codec, &webp_codec, &heif_codec};
    return all;
}

const image_codec& codec_of(const image_file& file) {
    std::array<std::uint8_t, probed_bytes> start{};
    const std::size_t count = std::fread(start.data(), 1, start.size(), file.rewound());
    if (count == 0) file.refuse("it is empty");
    for (const image_codec* codec : all_image_codecs())
        if (codec->probe(std::span(start).first(count))) return *codec;
    file.refuse("it is not a " + image_formats() + " image");
}

std::string image_formats() {
    std::vector<std::string_view> names;
    for (const image_codec* codec : all_image_codecs()) names.push_back(codec->name);
    return enumerated(names, " or ");
}

std::vector<std::string_view> image_endings() {
    std::vector<std::string_view> endings;
    for (const image_codec* codec : all_image_codecs())
        endings.insert(endings.end(), codec->endings.begin(), codec->endings.end());
    return endings;
}

}  // namespace gs
