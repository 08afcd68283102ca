// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "../checkpoint/exchange_buffer.hpp"
#include "../device/device.hpp"
#include "../model/parameter_memory.hpp"
#include "../render/project/shown_blocks.hpp"
#include "../render/tiles/view_stack.hpp"
#include "adam.hpp"
#include "block_cache.hpp"
#include "parameter_storage.hpp"

namespace gs::train {

/// The parameters of the Gaussians in training, with the state of Adam. Several ranks divide most of them:
/// each one has the SH coefficients above degree 0 and Adam's moments of its own Gaussians only.
template <device::device Device>
struct trained_parameters {
    parameter_memory<Device> values{divided_arrays::view_dependent};
    /// Adam's moments, in one of two forms: see `moment_precision`.
    /// @{
    parameter_memory<Device> first, second;
    parameter_memory<Device, std::uint32_t, packed_width> packed;
    moment_precision precision = moment_precision::full;
    /// @}
    /// The last step that updated each Gaussian.
    typename Device::template buffer<std::uint32_t> last_step;
    block_cache<Device> cache;
    /// The Gaussians of each rank if the ranks divide them: see `divide`.
    std::optional<ranks::shares> shares;

    /// Returns the Gaussians of this rank, of `count`.
    ranks::share own(Device& device, std::size_t count) const {
        return shares ? shares->of(device.ranks().rank()) : ranks::share{0, count};
    }
    /// Leaves this rank only its own part of what ranks divide, until `set_values`. `among`: the Gaussians of
    /// each rank. Moments, if there are any, must be whole, or divided so already.
    void divide(Device& device, const ranks::shares& among) {
        flush_cache(device);
        shares = among;
        for (auto* floats : {&values, &first, &second}) floats->divide(device, own(device, 0));
        packed.divide(device, own(device, 0));
    }
    /// Gives this rank the values of all Gaussians, until `divide`. All ranks must call this.
    void undivide_values(Device& device) {
        if (!values.is_divided()) return;
        flush_cache(device);
        values.divide(device, {});
        gather_values(device, true);
    }
    /// Records that all arrays are divided so now.
    void set_shares(Device& device, const ranks::shares& among) {
        shares = among;
        for (auto* floats : {&values, &first, &second}) floats->set_division(own(device, 0));
        packed.set_division(own(device, 0));
    }
    /// Gives this rank the present values of all Gaussians that ranks do not divide. All ranks must call
    /// this.
    void update_values(Device& device) {
        if (shares) gather_values(device, false);
    }
    /// Calls f(array) for `values` and each array of moments that is in use.
    template <class F>
    void for_each(const F& f) {
        f(values);
        for_each_moment(f);
    }
    template <class F>
    void for_each_moment(const F& f) {
        if (precision == moment_precision::compact) {
            f(packed);
        } else {
            f(first);
            f(second);
        }
    }
    /// Replaces the values, and frees the moments. Waits for the device.
    void set_values(Device& device, const gaussians& model) {
        drop_cache();
        free_moments();
        shares.reset();
        for (auto* floats : {&first, &second}) floats->set_division({});
        packed.set_division({});
        values.upload(device, model);
    }
    /// Returns the values of the first `count` Gaussians. All ranks must call this if they divide them. Waits
    /// for the device.
    gaussians get_values(Device& device, std::size_t count, int sh_degree) {
        flush_cache(device);
        return values.download(device, count, sh_degree);
    }
    /// See `parameter_memory::change_sh_degree`.
    void change_sh_degree(Device& device, int from, int to) {
        flush_cache(device);
        for_each([&](auto& memory) { memory.change_sh_degree(device, from, to); });
    }
    /// Moves the values to the places of this storage. Moments follow, unless their precision changes: then
    /// they are freed.
    void set_storage(Device& device, const parameter_storage& how) {
        flush_cache(device);
        if (how.precision != precision) free_moments();
        precision = how.precision;
        values.move_to_host_from(device, how.first_degree_on_host);
        for (auto* moments : {&first, &second}) moments->move_to_host_from(device, how.first_degree_on_host);
        packed.move_to_host_from(device, how.first_degree_on_host);
    }
    /// Fetches the blocks that the views show, if some parameters lie in host memory: see `block_cache`.
    void fetch(Device& device, const raster::view_stack& views) {
        if (cache.blocks() == 0) return;
        for (std::size_t v = 0; v < views.count(); ++v)
            raster::find_shown_blocks(device, values.read().mean, values.gaussians_with_sh(), views[v],
                                      cache.needed(), v > 0);
        cache.fetch(device);
    }
    /// Writes the cache back and frees it. Must precede all accesses to arrays except by kernels that heed
    /// `parameter_arrays::cache_slot`.
    void flush_cache(Device& device) {
        cache.write_back(device);
        drop_cache();
    }
    /// Allocates what only steps need, because the storage of a new model is known only then: moments,
    /// which are zero at first, and memory for the cache.
    void require_memory(Device& device, std::size_t count, int sh_degree) {
        if (last_step.size() != count) {
            flush_cache(device);
            for_each_moment([&](auto& moments) {
                moments.resize(count, values.gaussians_with_sh(), sh_degree);
                moments.zero(device);
            });
            last_step.resize(count);
            device.zero(last_step.data(), count);
        }
        const std::size_t blocks =
            values.is_on_host() ? in_whole_blocks(values.gaussians_with_sh()) / block_length : 0;
        if (cache.blocks() == blocks) return;
        const std::size_t slots = cache.reset(device, blocks);
        for_each([&](auto& memory) {
            memory.reserve_cache(slots, cache.slot_of());
            cache.add(memory);
        });
    }
    /// Returns a number that determines the memory and the launches of a step, for graph keys.
    std::size_t memory_key() const { return 2 * values.gaussians_with_sh() + (cache.blocks() > 0 ? 1 : 0); }
    /// Returns whether all arrays have the sizes for this number of Gaussians and this SH degree.
    bool fits(std::size_t count, int sh_degree) {
        bool fits = last_step.size() == count;
        for_each([&](auto& memory) {
            fits = fits && memory.fits(count, sh_degree) &&
                   memory.gaussians_with_sh() == values.gaussians_with_sh();
        });
        return fits;
    }
    moment_arrays moments() { return {first.write(), second.write(), packed.write()}; }
    /// Calls `use` with Adam's step number t, counted from 1, with learning rates by `parameter`.
    template <class F>
    void descend(std::uint32_t t, const std::array<float, parameter_count>& rates,
                 const raster::list_capacity& capacity, const finite_check& check, const F& use) {
        if (precision == moment_precision::compact)
            use(descent<moment_precision::compact>(t, rates, capacity, check));
        else
            use(descent<moment_precision::full>(t, rates, capacity, check));
    }
    /// Saves or loads all parameters. Loading takes over the precision. All ranks must call this. Waits for
    /// the device.
    void exchange(state_archive& archive, Device& device) {
        flush_cache(device);
        const auto exchange_memory = [&](const char* name, auto& memory) {
            const state_archive::scope scope(archive, name);
            memory.exchange(archive, device);
        };
        if (archive.loads()) {
            free_moments();
            const state_archive::scope scope(archive, "moments");
            precision = archive.has("mean") ? moment_precision::compact : moment_precision::full;
        }
        exchange_memory("values", values);
        if (precision == moment_precision::compact) {
            exchange_memory("moments", packed);
        } else {
            exchange_memory("first_moments", first);
            exchange_memory("second_moments", second);
        }
        exchange_buffer(archive, device, "last_step", last_step);
    }

  private:
    template <moment_precision Precision>
    adam<float, Precision> descent(std::uint32_t t, const std::array<float, parameter_count>& rates,
                                   const raster::list_capacity& capacity, const finite_check& check) {
        using step_type = adam<float, Precision>;
        const double by_first = 1 / (1 - std::pow(step_type::beta1, t));
        const double by_second = 1 / std::sqrt(1 - std::pow(step_type::beta2, t));
        step_type step{values.write(), moments(), last_step.data(), t, {}, static_cast<float>(by_second),
                       capacity,       check};
        // A shared second moment exceeds that of most coefficients, so that their steps are shorter.
        constexpr double of_shared = Precision == moment_precision::compact ? 1.5 : 1;
        for (std::size_t p = 0; p < parameter_count; ++p)
            step.rates[p] = static_cast<float>(rates[p] * by_first * (is_view_dependent(p) ? of_shared : 1));
        return step;
    }
    void gather_values(Device& device, bool divided) {
        std::vector<ranks::shared_array> arrays;
        values.share(divided, arrays);
        if (!divided)
            arrays.push_back(ranks::shared_array::of(last_step.data(), block_length, last_step.size()));
        device.gather(*shares, arrays);
    }
    void drop_cache() {
        cache.drop();
        for_each([](auto& memory) { memory.reserve_cache(0, nullptr); });
    }
    void free_moments() {
        for (auto* moments : {&first, &second}) moments->free();
        packed.free();
        last_step = {};
    }
};

}  // namespace gs::train
