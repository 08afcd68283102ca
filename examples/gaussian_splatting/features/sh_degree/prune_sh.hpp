// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../core/bits.hpp"
#include "../../densify/parameter_gather.hpp"
#include "../../densify/score_views.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "sh_error.hpp"

namespace gs::train {

/// Rates Gaussians by their `sh_error`, and marks all of them to keep their SH coefficients. One
/// index per Gaussian.
struct rate_by_sh_error {
    const sh_error* errors;
    std::uint32_t* keeps;
    std::uint32_t* rating;  ///< sort key, which increases with the error
    std::uint32_t* identities;

    WARPAGG_HD void operator()(std::size_t i) const {
        keeps[i] = 1;
        rating[i] = errors[i].squares > 0 ? raster::bits_of(errors[i].squares) : 0;
        identities[i] = static_cast<std::uint32_t>(i);
    }
};

/// Gives a Gaussian that loses its SH coefficients its mean color, if it was seen. One index per
/// Gaussian.
struct take_mean_color {
    const sh_error* errors;
    const std::uint32_t* keeps;
    float* sh0;

    WARPAGG_HD void operator()(std::size_t i) const {
        if (keeps[i] != 0 || !(errors[i].weight > 0)) return;
        for (std::size_t c = 0; c < 3; ++c) sh0[aosoa_index(i, c, 3)] = sh_from_color(errors[i].mean[c]);
    }
};

/// Places Gaussians that keep their SH coefficients before the others. Both groups keep their
/// order. One index per Gaussian.
struct place_sh_first {
    std::size_t count;
    const std::uint32_t* keeps;
    const std::uint64_t* first;  ///< number of previous Gaussians that keep them
    std::uint32_t* origin;
    birth* births;

    WARPAGG_HD void operator()(std::size_t i) const {
        const std::uint64_t at = keeps[i] != 0 ? first[i] : first[count] + (i - first[i]);
        origin[at] = static_cast<std::uint32_t>(i);
        births[at] = birth::kept;
    }
};

/// Removes the SH coefficients of Gaussians whose color hardly depends on direction, and frees
/// their memory.
template <device::device Device>
class sh_pruner {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    sh_pruner(Device& device, parameter_gather<Device>& gather) : device_(device), gather_(gather) {}

    /// Measures the `sh_error` of `count` Gaussians over all views. Prunes as many Gaussians as
    /// change the renders by a root mean square of at most `change`. Cost: renders each view once.
    void run(trained_parameters<Device>& all, std::size_t count, int sh_degree, score_views& views,
             double change) {
        buffer<sh_error> errors;
        buffer<float> ones;
        errors.resize(count);
        device_.zero(errors.data(), count);
        std::size_t values = 0;
        for (std::size_t v = 0; v < views.count(); ++v) {
            const drawn_view drawn = views.draw(v);
            const std::size_t n = 3 * static_cast<std::size_t>(drawn.target.width) *
                                  static_cast<std::size_t>(drawn.target.height);
            ones.resize(n);
            device_.for_each_index(n, make_one{ones.data()});
            device_.for_each_index(
                all.own(device_, count),
                add_sh_error{drawn.splats, drawn.tiles, views.sum_scores(ones.data()), errors.data()});
            values += n;
        }
        views.gather(ranks::shared_array::of(errors.data(), block_length, count));
        prune(all, count, sh_degree, errors.data(), change * change * static_cast<double>(values));
    }

    /// Prunes as many of `count` Gaussians as possible, so that the `sh_error::squares` of all
    /// pruned ones sum to at most `squares`. Pruned Gaussians take their mean color and come last.
    /// Prunes none if they are less than a tenth of those with SH coefficients. Waits for the
    /// device once.
    void prune(trained_parameters<Device>& all, std::size_t count, int sh_degree, const sh_error* errors,
               double squares) {
        for (auto* b : {&keeps_, &rating_, &gaussian_of_}) b->resize(count);
        first_.resize(count + 1);
        gather_.reserve(count);
        device_.for_each_index(count,
                               rate_by_sh_error{errors, keeps_.data(), rating_.data(), gaussian_of_.data()});
        device_.sort_pairs(rating_, gaussian_of_, count);
        std::vector<std::uint32_t> ascending(count);
        device_.download(ascending.data(), rating_.data(), count);
        std::size_t without = 0;
        for (double sum = 0; without < count; ++without) {
            sum += static_cast<double>(std::bit_cast<float>(ascending[without]));
            if (!(sum <= squares)) break;
        }
        const std::size_t with = in_whole_blocks(count - without), before = all.values.gaussians_with_sh();
        if (with + before / 10 > before) return;
        device_.for_each_index(count - with, clear_ranked{gaussian_of_.data(), keeps_.data()});
        device_.for_each_index(count, take_mean_color{errors, keeps_.data(), all.values.write().sh[0]});
        device_.prefix_sum(keeps_, first_, count);
        device_.for_each_index(
            count, place_sh_first{count, keeps_.data(), first_.data(), gather_.origins(), gather_.births()});
        gather_.run(all, count, with, sh_degree);
        gather_.release();
    }

  private:
    Device& device_;
    parameter_gather<Device>& gather_;
    buffer<std::uint32_t> keeps_, rating_, gaussian_of_;
    buffer<std::uint64_t> first_;
};

}  // namespace gs::train
