// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "compared_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <span>
#include <utility>

#include "../../core/median.hpp"
#include "../../core/parallel.hpp"
#include "../../engine/engine.hpp"
#include "../../image/image.hpp"
#include "../../scene/view_photo.hpp"

namespace gs::features {
namespace {

constexpr std::size_t most_photos = 120;
constexpr std::size_t most_observations = 20000;  ///< for least-squares fits
constexpr std::size_t most_observations_of_all = 100000;
constexpr int blocks_across = 128;                ///< about, of a photo
constexpr int least_value = 3, most_value = 252;  ///< of a channel that is not saturated
constexpr float darkest = 0.03f;                  ///< of a render whose ratio is meaningful
constexpr float edge = 0.1f;                      ///< relative change of the inverse depth between neighbors
constexpr double sky_distance = 50;               ///< beyond which all is sky, in units of the extent
constexpr double sky_cell = 0.1;                  ///< in radians
constexpr double footprints = 4, footprints_of_all = 3;  ///< side of a cell of space
constexpr double smooth_share = 0.6;                     ///< share of the samples that are smooth enough
constexpr double largest_roughness = 0.25;

/// A block of pixels in a photo and in the render.
struct block {
    glm::vec3 photo{0}, render{0};
    float inverse_depth = 0;
    bool is_known = true;
};

/// Returns the side of the blocks of a view.
int side_of_blocks(const camera& c) {
    return std::max(1, static_cast<int>(std::sqrt(double(c.width) * c.height) / blocks_across));
}

/// A photo and its render in blocks of pixels.
struct blocks {
    int side, width, height;
    std::vector<block> all;

    /// `render` and `inverse` have the means of the blocks.
    blocks(const camera& c, const image& photo, std::span<const float> render, std::span<const float> inverse)
        : side(side_of_blocks(c)),
          width(c.width / side),
          height(c.height / side),
          all(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            block& b = all[i];
            b.inverse_depth = inverse[i];
            for (int k = 0; k < 3; ++k) b.render[k] = render[static_cast<std::size_t>(k) * all.size() + i];
        }
        for (int y = 0; y < height * side; ++y)
            for (int x = 0; x < width; ++x)
                add_row(all[index(x, y / side)],
                        &photo.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(c.width) +
                                         static_cast<std::size_t>(x * side))]);
    }
    /// Adds a row of pixels of a photo to a block.
    void add_row(block& b, const std::uint8_t* rgba) const {
        glm::ivec3 sum(0);
        bool is_known = true;
        for (const std::uint8_t* const end = rgba + 4 * side; rgba < end; rgba += 4) {
            is_known = is_known && rgba[3] == 255;
            for (int k = 0; k < 3; ++k) {
                sum[k] += rgba[k];
                is_known = is_known && rgba[k] >= least_value && rgba[k] <= most_value;
            }
        }
        b.photo += glm::vec3(sum) / static_cast<float>(255 * side * side);
        b.is_known = b.is_known && is_known;
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// A place in a photo with its 3x3 blocks.
struct sample {
    std::uint32_t view;
    glm::vec2 place;
    glm::vec3 direction, position;
    glm::vec3 log_ratio, log_render;
    float footprint;  ///< width of a block at the surface, or zero for the sky
    float roughness;
};

/// The smallest and the largest of some numbers.
struct value_range {
    float least = std::numeric_limits<float>::infinity(), most = 0;
    void add(float x) {
        least = std::min(least, x);
        most = std::max(most, x);
    }
    float relative() const { return most > 0 ? (most - least) / most : 0; }
};

float sum(const glm::vec3& color) { return color.r + color.g + color.b; }

/// Compares the blocks around (x, y). Returns false if they tell nothing.
bool compare(const blocks& of, int x, int y, sample& s, value_range& depths) {
    glm::vec3 photo(0), render(0);
    value_range ratios;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const block& b = of.all[of.index(x + dx, y + dy)];
            if (!b.is_known) return false;
            photo += b.photo;
            render += b.render;
            depths.add(b.inverse_depth);
            ratios.add(sum(b.photo) / std::max(sum(b.render), 1e-3f));
        }
    for (int k = 0; k < 3; ++k) {
        if (!(render[k] > 9 * darkest)) return false;
        s.log_ratio[k] = std::log(photo[k] / render[k]);
        s.log_render[k] = std::log(render[k] / 9);
    }
    s.roughness = ratios.relative();
    return true;
}

std::vector<sample> samples_of(const blocks& of, std::size_t view, const camera& c, double extent) {
    std::vector<sample> made;
    const glm::dvec3 forward = glm::transpose(c.rotation) * glm::dvec3(0, 0, 1);
    for (int y = 1; y + 1 < of.height; ++y)
        for (int x = 1; x + 1 < of.width; ++x) {
            sample s{};
            value_range depths;
            if (!compare(of, x, y, s, depths)) continue;
            s.view = static_cast<std::uint32_t>(view);
            const glm::dvec2 place((x + 0.5) * of.side, (y + 0.5) * of.side);
            const glm::dvec3 ray = c.ray(place.x, place.y);
            s.place = place;
            s.direction = ray;
            const double inverse = static_cast<double>(of.all[of.index(x, y)].inverse_depth);
            if (inverse * extent * sky_distance > 1) {
                if (depths.relative() > edge) continue;
                const bool is_pinhole = c.lens() == lens_model::pinhole;
                s.position = c.center() + ray / (inverse * (is_pinhole ? glm::dot(ray, forward) : 1.0));
                s.footprint = static_cast<float>(of.side / (inverse * std::sqrt(c.fx * c.fy)));
            }
            made.push_back(s);
        }
    return made;
}

/// Returns the samples of all examined photos, in the order of these.
std::vector<sample> all_samples(train::engine& engine, const scene& of, const show_function& show,
                                const std::array<float, 3>& background) {
    std::vector<std::size_t> views;  // panoramas have no corners
    for (std::size_t v = 0; v < of.train.size(); ++v)
        if (!of.train[v].camera.is_panorama) views.push_back(v);
    const std::size_t photos = std::min(views.size(), most_photos);
    std::vector<std::vector<float>> renders(photos), inverses(photos);
    std::vector<camera> cameras(photos);  // with the poses that training has learned
    const auto view_of = [&](std::size_t photo) { return views[photo * views.size() / photos]; };
    for (std::size_t i = 0; i < photos; ++i) {
        const std::size_t v = view_of(i);
        cameras[i] = engine.cameras().training_camera(v, of.train[v].camera);
        const int side = side_of_blocks(cameras[i]);
        renders[i] = engine.render(cameras[i], background, {.block = side});
        inverses[i] = engine.render(cameras[i], {}, {.inverse_depth = true, .block = side});
    }
    std::vector<std::vector<sample>> by_photo(photos);
    for_each_in_parallel(photos, [&](std::size_t i) {
        const std::size_t v = view_of(i);
        const camera& c = cameras[i];
        show(v, {c.width, c.height, {}, side_of_blocks(c)}, renders[i]);
        const view_photo photo(of.train[v]);
        by_photo[i] = samples_of(blocks(c, photo.pixels(), renders[i], inverses[i]), v, c, of.extent());
    });
    std::vector<sample> all;
    for (const auto& samples : by_photo) all.insert(all.end(), samples.begin(), samples.end());
    return all;
}

using cell_index = std::array<int, 3>;

/// A sample and its cell. Their order is that of cells, and then of samples.
using sample_in_cell = std::pair<cell_index, const sample*>;

cell_index cell_at(const glm::vec3& position, double side) {
    cell_index found;
    for (int k = 0; k < 3; ++k)
        found[static_cast<std::size_t>(k)] =
            static_cast<int>(std::floor(static_cast<double>(position[k]) / side));
    return found;
}

/// Returns the observations of a cell, one for each photo that shows it.
std::vector<observation> observations_of(std::span<const sample_in_cell> samples) {
    const auto sample_at = [&](std::size_t i) -> const sample& { return *samples[i].second; };
    glm::vec3 typical(0);
    for (std::size_t i = 0; i < samples.size(); ++i)
        typical += sample_at(i).log_render / static_cast<float>(samples.size());
    std::vector<observation> seen;
    for (std::size_t first = 0, end = 0; first < samples.size(); first = end) {
        while (end < samples.size() && sample_at(end).view == sample_at(first).view) ++end;
        const float weight = 1.0f / static_cast<float>(end - first);
        observation o;
        o.view = sample_at(first).view;
        o.footprint = 1;
        glm::vec3 log = typical;
        for (std::size_t i = first; i < end; ++i) {
            log += weight * sample_at(i).log_ratio;
            o.place += static_cast<double>(weight) * glm::dvec2(sample_at(i).place);
            o.direction += weight * sample_at(i).direction;
        }
        for (int k = 0; k < 3; ++k) o.color[k] = std::exp(log[k]);
        seen.push_back(o);
    }
    return seen;
}

/// Returns observations of the cells that enough photos show, or of a part of these cells if there would be
/// more than `most` observations.
observed_points observe_cells(std::vector<sample_in_cell> samples, std::size_t most) {
    sort_in_parallel(samples);
    observed_points all, some;
    std::size_t count = 0;
    for (std::size_t first = 0, end = 0; first < samples.size(); first = end) {
        while (end < samples.size() && samples[end].first == samples[first].first) ++end;
        auto seen = observations_of(std::span(samples).subspan(first, end - first));
        if (seen.size() < scene_statistics::least_photos_of_point) continue;
        count += seen.size();
        all.push_back(std::move(seen));
    }
    const std::size_t step = count / most + 1;
    for (std::size_t i = 0; i < all.size(); i += step) {
        for (observation& o : all[i]) o.point = static_cast<std::uint32_t>(some.size());
        some.push_back(std::move(all[i]));
    }
    return some;
}

}  // namespace

compared_surfaces compare_with_photos(train::engine& engine, const scene& scene, const show_function& show,
                                      const std::array<float, 3>& background) {
    const std::vector<sample> samples = all_samples(engine, scene, show, background);
    std::vector<double> roughness, sizes;
    for (const sample& s : samples) {
        if (s.footprint == 0) continue;
        roughness.push_back(static_cast<double>(s.roughness));
        sizes.push_back(static_cast<double>(s.footprint));
    }
    const double limit = roughness.empty() ? largest_roughness
                                           : std::min(largest_roughness, quantile(roughness, smooth_share));
    const double footprint = sizes.empty() ? 1 : median(sizes);
    std::vector<sample_in_cell> smooth, all, sky;
    for (const sample& s : samples) {
        const bool is_smooth = static_cast<double>(s.roughness) <= limit;
        if (s.footprint == 0) {
            if (is_smooth) sky.emplace_back(cell_at(s.direction, sky_cell), &s);
            continue;
        }
        all.emplace_back(cell_at(s.position, footprints_of_all * footprint), &s);
        if (is_smooth) smooth.emplace_back(cell_at(s.position, footprints * footprint), &s);
    }
    return {observe_cells(std::move(smooth), most_observations),
            observe_cells(std::move(all), most_observations_of_all),
            observe_cells(std::move(sky), most_observations)};
}

}  // namespace gs::features
