// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "exif.hpp"

#include <libexif/exif-data.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

namespace gs {
namespace {

constexpr std::uint8_t exif_signature[] = {'E', 'x', 'i', 'f', 0, 0};

struct data_deleter {
    void operator()(ExifData* data) const { exif_data_unref(data); }
};

/// Returns what the values 1 to 8 of the tag Orientation mean.
orientation meaning_of(unsigned tag) {
    switch (tag) {
        case 2:
            return {.mirrors_x = true};
        case 3:
            return {.mirrors_x = true, .mirrors_y = true};
        case 4:
            return {.mirrors_y = true};
        case 5:
            return {.swaps_sides = true};
        case 6:
            return {.swaps_sides = true, .mirrors_y = true};
        case 7:
            return {.swaps_sides = true, .mirrors_x = true, .mirrors_y = true};
        case 8:
            return {.swaps_sides = true, .mirrors_x = true};
        default:
            return {};
    }
}

}  // namespace

orientation orientation_in_exif(std::span<const std::uint8_t> data) {
    // libexif requires the signature, which only JPEGs contain.
    std::vector<std::uint8_t> bytes(std::begin(exif_signature), std::end(exif_signature));
    const bool has_signature =
        data.size() > bytes.size() && std::equal(bytes.begin(), bytes.end(), data.begin());
    if (has_signature) bytes.clear();
    bytes.insert(bytes.end(), data.begin(), data.end());
    if (bytes.size() > std::numeric_limits<unsigned>::max()) return {};

    const std::unique_ptr<ExifData, data_deleter> parsed(exif_data_new());
    if (!parsed) return {};
    exif_data_unset_option(parsed.get(), EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);  // keeps data as it is
    exif_data_load_data(parsed.get(), bytes.data(), static_cast<unsigned>(bytes.size()));
    const ExifEntry* entry = exif_content_get_entry(parsed->ifd[EXIF_IFD_0], EXIF_TAG_ORIENTATION);
    if (!entry || entry->format != EXIF_FORMAT_SHORT || entry->components < 1 || entry->size < 2) return {};
    return meaning_of(exif_get_short(entry->data, exif_data_get_byte_order(parsed.get())));
}

}  // namespace gs
