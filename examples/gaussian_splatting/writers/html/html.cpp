// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "html.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "../../core/atomic_file_write.hpp"
#include "../../core/byte_size.hpp"
#include "../../edit/edit.hpp"
#include "../../scene/look_at.hpp"
#include "../compressed_ply/compressed_ply.hpp"

namespace gs {
namespace {

constexpr std::string_view endings[] = {".html"};
constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

/// Returns a bound of the size of a compressed PLY file.
std::uint64_t compressed_size(std::size_t count, int sh_degree) {
    constexpr std::uint64_t header = 4096, vertex = 16, chunk = 72, chunk_size = 256;
    const auto coefficients = static_cast<std::uint64_t>(3 * (sh_coefficients(sh_degree) - 1));
    return header + count * (vertex + coefficients) + (count / chunk_size + 1) * chunk;
}

/// Returns the largest number of Gaussians, at most `count`, with which a page has this size.
std::size_t count_for(const pages::viewer_scene& scene, std::size_t count, int sh_degree,
                      std::uint64_t most_bytes) {
    std::size_t fits = 0, exceeds = count + 1;
    while (exceeds - fits > 1) {
        const std::size_t middle = fits + (exceeds - fits) / 2;
        const bool is_small = viewer_page_size(scene, compressed_size(middle, sh_degree)) <= most_bytes;
        (is_small ? fits : exceeds) = middle;
    }
    return fits;
}

/// Returns the smallest and the largest value of the middle half of one coordinate of the means.
std::pair<double, double> quartiles(const gaussians& model, std::size_t axis) {
    const std::size_t count = model.count();
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = model.mean[3 * i + axis];
    const auto at = [&](std::size_t rank) {
        std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(rank));
        return double(values[rank]);
    };
    const double low = at(count / 4);
    return {low, at(count - 1 - count / 4)};
}

/// Returns a view of the middle half of the Gaussians, from outside and slightly from above. As in
/// other viewers, -y is up.
pages::viewer_scene framing_scene(const gaussians& model) {
    pages::viewer_scene scene;
    glm::dvec3 spread(1);
    if (model.count() > 0)
        for (int axis = 0; axis < 3; ++axis) {
            const auto [low, high] = quartiles(model, static_cast<std::size_t>(axis));
            scene.pivot[axis] = (low + high) / 2;
            spread[axis] = high - low;
        }
    scene.radius = 2.5 * std::max(glm::length(spread), 1e-6);
    scene.near_plane = 0.001 * scene.radius;
    const glm::dvec3 back(0, 0, -1);
    const glm::dvec3 from = scene.pivot + scene.radius * glm::normalize(back + 0.3 * scene.up);
    constexpr int size = 1000;
    scene.views = {look_at(from, scene.pivot, scene.up, size, 1.2 * size)};
    return scene;
}

void write_html(const std::filesystem::path& file, const gaussians& model, const write_options& options) {
    write_viewer(
        file, model, framing_scene(model), no_limit, [](const std::string&) {}, options);
}

}  // namespace

void write_viewer(const std::filesystem::path& file, const gaussians& model, pages::viewer_scene scene,
                  std::uint64_t most_bytes, const log_function& log, const write_options& options) {
    scene.antialiased = model.antialiased;
    scene.sky = model.sky;
    scene.gaussians = model.count();
    const int sh_degree = std::min(model.sh_degree, options.max_sh_degree);
    const std::size_t fitting = count_for(scene, model.count(), sh_degree, most_bytes);
    const auto write = [&](const gaussians& shown) {
        atomic_file_write(file, [&](std::ostream& out) {
            write_viewer_page(
                out, scene, [&](std::ostream& splat) { write_compressed_ply(splat, file, shown, options); });
        });
    };
    if (fitting == model.count()) return write(model);
    log(file.filename().string() + " shows the " + std::to_string(fitting) + " most important of " +
        std::to_string(model.count()) + " Gaussians, to have at most " + size_in_bytes(most_bytes) +
        ": raise --viewer-size to show more");
    write(edit::decimate(model, fitting));
}

constinit const writer html_writer{"HTML", endings, write_html};

}  // namespace gs
