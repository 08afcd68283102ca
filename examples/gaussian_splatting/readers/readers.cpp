// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include "../core/enumerated.hpp"
#include "colmap/colmap.hpp"
#include "opensfm/opensfm.hpp"
#include "polycam/polycam.hpp"
#include "reader.hpp"
#include "synthetic/synthetic.hpp"
#include "transforms/blender.hpp"
#include "transforms/nerfstudio.hpp"

namespace gs {

std::span<const reader* const> all_readers() {
    static constexpr const reader* table[] = {
        &synthetic_reader,  &blender_reader, &colmap_reader,
        &nerfstudio_reader, &polycam_reader, &opensfm_reader,
    };
    return table;
}

std::string accepted_scenes(std::span<const reader* const> readers) {
    std::vector<std::string_view> parts;
    for (const reader* one : readers) parts.push_back(one->accepts);
    parts.push_back("a .zip archive of such a folder");
    return enumerated(parts, " or ");
}

std::string readers_with(std::string_view option, std::span<const reader* const> readers) {
    std::vector<std::string_view> names;
    for (const reader* one : readers)
        if (std::ranges::find(one->options, option, &reader_option::name) != one->options.end())
            names.push_back(one->name);
    return enumerated(names, " and ");
}

}  // namespace gs
