// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "harness.hpp"
#include "writers/writer.hpp"

namespace gs_fuzz {
namespace {

/// Returns how many times their own size the files of a format may grow in memory, beyond the usual
/// bound.
std::size_t further_growth(std::string_view format) {
    if (format == "spz") return 5000;  // may decompress to 1000 times its size, and becomes floats
    if (format == "sog") return 5000;  // 10 Gaussians for each byte, with images and floats; a palette
    if (format == "gltf") return 100;  // a JSON document; attributes may share their data
    return 0;
}

/// The memory of zstd and zlib themselves.
constexpr std::size_t decompressor = 512 << 10;

std::vector<harness> make_harnesses() {
    std::vector<harness> all{{"colmap_binary", colmap_binary},
                             {"colmap_text", colmap_text},
                             {"transforms", transforms},
                             {"polycam", polycam},
                             {"opensfm", opensfm},
                             {"point_cloud", point_cloud},
                             {"archive", archive},
                             {"image", image}};
    for (const gs::writer* one : gs::all_writers()) {
        if (!one->read) continue;
        std::string name(one->name);
        std::ranges::transform(name, name.begin(),
                               [](unsigned char c) { return c == ' ' ? '_' : std::tolower(c); });
        const std::size_t growth = further_growth(name);
        all.push_back({name, [growth, read = one->read](std::string_view input) {
                           return load_within_budget(
                               input, [read](const std::filesystem::path& file) { read(file); },
                               [&] { return growth == 0 ? 0 : decompressor + growth * input.size(); });
                       }});
    }
    return all;
}

}  // namespace

const std::vector<harness>& harnesses() {
    static const std::vector<harness> all = make_harnesses();
    return all;
}

const harness& harness_of(std::string_view name) {
    const auto found = std::ranges::find(harnesses(), name, &harness::name);
    if (found == harnesses().end()) throw std::out_of_range("no harness is called " + std::string(name));
    return *found;
}

}  // namespace gs_fuzz
