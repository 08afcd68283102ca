// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "compressed_ply/compressed_ply.hpp"
#include "gltf/gltf.hpp"
#include "html/html.hpp"
#include "ply/ply.hpp"
#include "sog/sog.hpp"
#include "splat/splat.hpp"
#include "spz/spz.hpp"
#include "writer.hpp"

namespace gs {

std::span<const writer* const> all_writers() {
    static constexpr const writer* table[] = {
        &ply_writer, &compressed_ply_writer, &splat_writer, &html_writer,
        &spz_writer, &gltf_writer,           &sog_writer,
    };
    return table;
}

}  // namespace gs
