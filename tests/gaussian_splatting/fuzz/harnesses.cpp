// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "harness.hpp"
#include "writers/writer.hpp"

namespace gs_fuzz {
namespace {

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
        all.push_back({name, [read = one->read](std::string_view input) {
                           return load_within_budget(
                               input, [read](const std::filesystem::path& file) { read(file); });
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
