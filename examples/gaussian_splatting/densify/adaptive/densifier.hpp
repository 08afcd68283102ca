// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../../device/device.hpp"
#include "../../model/parameter_memory.hpp"
#include "densify_kernels.hpp"

namespace gs::train {

/// What is trained: values and the moments of Adam.
template <device::device Device>
struct trained_parameters {
    parameter_memory<Device> values, first, second;
    typename Device::template buffer<std::uint32_t> last_step;
};

/// From one generation of Gaussians to the next, on a device, and the memory that it takes.
template <device::device Device>
class densification {
    template <class T>
    using buffer = typename Device::template buffer<T>;

  public:
    explicit densification(Device& device) : device_(device) { tally_.resize(1); }

    /// Replaces `count` Gaussians by those of `densify_rule`, and says how many there are then and how many
    /// of those before were silent. Waits for the device, once.
    densify_tally run(trained_parameters<Device>& of, std::size_t count, int sh_degree,
                      const raster::visibility* seen, const densify_rule& rule) {
        begin(count, std::min(2 * count, std::max<std::size_t>(count, rule.cap)));
        device_.for_each_index(count,
                               judge_gaussians{of.values.read(), seen, rule, copies_.data(), large_.data(),
                                               urgency_.data(), gaussian_of_.data(), &tally_.data()->silent});
        device_.prefix_sum(copies_, first_copy_, count);
        device_.sort_pairs(urgency_, gaussian_of_, count);
        device_.for_each_index(
            count, let_grow{urgency_.data(), gaussian_of_.data(), first_copy_.data() + count, rule.cap,
                            rule.most_births, copies_.data()});
        const densify_tally tally = renew(of, count, sh_degree);
        device_.for_each_index(tally.count,
                               part_halves{births_.data(), rule.seed, rule.step, of.values.write()});
        if (rule.revised_opacity)
            device_.for_each_index(tally.count, revise_opacity{births_.data(), of.values.write().opacity});
        return tally;
    }

    /// Drops those of `count` Gaussians that matter least, so many, by what views saw of them. Waits for the
    /// device, once.
    void drop_least(trained_parameters<Device>& of, std::size_t count, int sh_degree,
                    const raster::visibility* seen, std::size_t dropped) {
        begin(count, count);
        device_.for_each_index(count,
                               rate_gaussians{seen, copies_.data(), urgency_.data(), gaussian_of_.data()});
        device_.sort_pairs(urgency_, gaussian_of_, count);
        device_.for_each_index(dropped, drop_ranked{gaussian_of_.data(), copies_.data()});
        renew(of, count, sh_degree);
    }

    /// Takes their bands, with the memory, from as many of `count` Gaussians as add up to at most `squares`
    /// by their spreads, and gives them their mean colours: they come last then. None loses any if it would
    /// be less than a tenth of those that have them. Waits for the device, once.
    void drop_bands(trained_parameters<Device>& of, std::size_t count, int sh_degree,
                    const colour_spread* spreads, double squares) {
        begin(count, count);
        device_.for_each_index(count,
                               rate_bands{spreads, copies_.data(), urgency_.data(), gaussian_of_.data()});
        device_.sort_pairs(urgency_, gaussian_of_, count);
        std::vector<std::uint32_t> ascending(count);
        device_.download(ascending.data(), urgency_.data(), count);
        std::size_t without = 0;
        for (double sum = 0; without < count; ++without) {
            sum += static_cast<double>(std::bit_cast<float>(ascending[without]));
            if (!(sum <= squares)) break;
        }
        const std::size_t banded = in_whole_blocks(count - without), before = of.values.banded();
        if (banded + before / 10 > before) return;
        device_.for_each_index(count - banded, drop_ranked{gaussian_of_.data(), copies_.data()});
        device_.for_each_index(count, take_mean_colour{spreads, copies_.data(), of.values.write().sh[0]});
        device_.prefix_sum(copies_, first_copy_, count);
        device_.for_each_index(count, place_banded_first{count, copies_.data(), first_copy_.data(),
                                                         origin_.data(), births_.data()});
        carry_all(of, count, banded, sh_degree);
        for (auto& s : spare_) s = buffer<float>();
    }

  private:
    void begin(std::size_t count, std::size_t most) {
        for (auto* b : {&copies_, &large_, &urgency_, &gaussian_of_}) b->resize(count);
        origin_.resize(most);
        births_.resize(most);
        first_copy_.resize(count + 1);
        device_.zero(tally_.data(), 1);
    }

    /// As many of each Gaussian as `copies_` says.
    densify_tally renew(trained_parameters<Device>& of, std::size_t count, int sh_degree) {
        device_.prefix_sum(copies_, first_copy_, count);
        device_.for_each_index(count, place_copies{copies_.data(), large_.data(), first_copy_.data(),
                                                   origin_.data(), births_.data()});
        device_.copy(&tally_.data()->count, first_copy_.data() + count, 1);
        densify_tally tally;
        device_.download(&tally, tally_.data(), 1);
        carry_all(of, tally.count, tally.count, sh_degree);
        return tally;
    }

    /// To `count` new Gaussians, of which the first `banded` have bands; bands of those without are zero.
    void carry_all(trained_parameters<Device>& of, std::size_t count, std::size_t banded, int sh_degree) {
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (has_parameter(p, sh_degree)) carry(of, p, is_band(p) ? banded : count);
        for (auto* all : {&of.values, &of.first, &of.second}) all->set_banded(banded);
        spare_steps_.resize(count);
        device_.for_each_index(count, carry_steps{origin_.data(), of.last_step.data(), spare_steps_.data()});
        of.last_step.resize(count);
        device_.copy(of.last_step.data(), spare_steps_.data(), count);
    }

    void carry(trained_parameters<Device>& of, std::size_t p, std::size_t count) {
        const std::size_t width = width_of(static_cast<parameter>(p)), n = in_whole_blocks(count) * width;
        constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
        const std::array arrays{&of.values[p], &of.first[p], &of.second[p]};
        for (auto& s : spare_) s.resize(n);
        device_.for_each_index(n, carry_over{count,
                                             is_band(p) ? of.values.banded() : all,
                                             origin_.data(),
                                             births_.data(),
                                             width,
                                             {arrays[0]->data(), arrays[1]->data(), arrays[2]->data()},
                                             {spare_[0].data(), spare_[1].data(), spare_[2].data()}});
        for (std::size_t k = 0; k < arrays.size(); ++k) {
            if (n < arrays[k]->size()) *arrays[k] = buffer<float>();  // gives memory back
            arrays[k]->resize(n);
            device_.copy(arrays[k]->data(), spare_[k].data(), n);
        }
    }

    Device& device_;
    buffer<std::uint32_t> copies_, large_, urgency_, gaussian_of_, origin_;
    buffer<birth> births_;
    buffer<std::uint64_t> first_copy_;
    buffer<densify_tally> tally_;
    std::array<buffer<float>, 3> spare_;  ///< for values and moments of one parameter
    buffer<std::uint32_t> spare_steps_;
};

}  // namespace gs::train
