// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "edit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numeric>

#include "../core/parallel.hpp"
#include "../scene/normalization.hpp"

namespace gs::edit {
namespace {

glm::dvec3 center(const gaussians& model, std::size_t i) {
    return {model.mean[3 * i], model.mean[3 * i + 1], model.mean[3 * i + 2]};
}

double opacity(const gaussians& model, std::size_t i) {
    return 1 / (1 + std::exp(-double(model.opacity[i])));
}

std::array<double, 3> sorted_log_scales(const gaussians& model, std::size_t i) {
    std::array<double, 3> s{model.log_scale[3 * i], model.log_scale[3 * i + 1], model.log_scale[3 * i + 2]};
    std::ranges::sort(s);
    return s;
}

/// Keeps the Gaussians for which `kept(i)` is true.
gaussians filtered(const gaussians& model, const auto& kept) {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < model.count(); ++i)
        if (kept(i)) indices.push_back(i);
    return select(model, indices);
}

bool is_in_image(const camera& c, const glm::dvec3& point) {
    const auto seen = c.see(point);
    return seen && seen->x >= 0 && seen->y >= 0 && seen->x <= c.width && seen->y <= c.height;
}

bool is_seen_often(const glm::dvec3& point, std::span<const camera> cameras) {
    std::size_t views = 0;
    for (const camera& c : cameras) {
        views += is_in_image(c, point);
        if (views == least_floater_views) return true;
    }
    return false;
}

}  // namespace

gaussians select(const gaussians& model, std::span<const std::size_t> indices) {
    gaussians result;
    result.sh_degree = model.sh_degree;
    result.antialiased = model.antialiased;
    result.sky = model.sky;
    const auto gather = [&](std::vector<float> gaussians::*array, std::size_t width) {
        (result.*array).reserve(width * indices.size());
        for (const std::size_t i : indices) {
            const auto first = (model.*array).begin() + static_cast<std::ptrdiff_t>(width * i);
            (result.*array).insert((result.*array).end(), first, first + static_cast<std::ptrdiff_t>(width));
        }
    };
    gather(&gaussians::mean, 3);
    gather(&gaussians::log_scale, 3);
    gather(&gaussians::quaternion, 4);
    gather(&gaussians::opacity, 1);
    gather(&gaussians::sh_constant, 3);
    gather(&gaussians::sh_rest, static_cast<std::size_t>(model.rest_width()));
    return result;
}

gaussians crop(const gaussians& model, const box& kept) {
    return filtered(model, [&](std::size_t i) {
        const glm::dvec3 p = center(model, i);
        return p.x >= kept.least.x && p.y >= kept.least.y && p.z >= kept.least.z && p.x <= kept.most.x &&
               p.y <= kept.most.y && p.z <= kept.most.z;
    });
}

gaussians decimate(const gaussians& model, std::size_t count) {
    if (count >= model.count()) return model;
    std::vector<double> log_importance(model.count());
    for (std::size_t i = 0; i < model.count(); ++i) {
        const auto scales = sorted_log_scales(model, i);
        const double x = model.opacity[i];
        const double log_opacity = x < 0 ? x - std::log1p(std::exp(x)) : -std::log1p(std::exp(-x));
        log_importance[i] = log_opacity + scales[1] + scales[2];
    }
    std::vector<std::size_t> order(model.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto is_before = [&](std::size_t a, std::size_t b) {
        return log_importance[a] != log_importance[b] ? log_importance[a] > log_importance[b] : a < b;
    };
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(order.begin(), end, order.end(), is_before);
    order.erase(end, order.end());
    std::ranges::sort(order);
    return select(model, order);
}

std::size_t share::of(std::size_t gaussians) const {
    if (percent == 0) return count;
    return static_cast<std::size_t>(std::ceil(static_cast<double>(gaussians) * percent / 100));
}

std::string share::text() const {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g%%", percent);
    return percent == 0 ? std::to_string(count) : digits;
}

gaussians remove_floaters(const gaussians& model, std::span<const camera> cameras) {
    if (model.count() == 0) return model;
    const normalization whole = normalization_of(model);
    const bool counts_views = cameras.size() >= least_floater_views;
    std::vector<char> kept(model.count());
    for_each_index_in_parallel(model.count(), [&](std::size_t i) {
        const double size = std::exp(sorted_log_scales(model, i)[2]);
        const bool is_veil = size > whole.scale && size > glm::distance(center(model, i), whole.origin);
        kept[i] = opacity(model, i) >= least_floater_opacity && !is_veil &&
                  (!counts_views || is_seen_often(center(model, i), cameras));
    });
    return filtered(model, [&](std::size_t i) { return kept[i] != 0; });
}

}  // namespace gs::edit
