// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../checkpoint/exchange_buffer.hpp"
#include "../device/device.hpp"
#include "aosoa.hpp"
#include "gaussians.hpp"
#include "parameters.hpp"

namespace gs {

/// Arrays in device memory, one per parameter, with `Widths` elements for each Gaussian, by parameter:
/// as many as the parameter has components, or another number for data about parameters. Their layout
/// is AoSoA: see `aosoa_index`.
template <device::device Device, class T = float, const auto& Widths = parameter_width>
class parameter_memory {
  public:
    using buffer = typename Device::template buffer<T>;

    /// Returns the number of elements of a parameter for each Gaussian.
    static constexpr std::size_t width(std::size_t p) { return static_cast<std::size_t>(Widths[p]); }

    /// Sets the number of Gaussians, of those with SH coefficients above degree 0, and the SH degree.
    /// Loses the contents. SH coefficients above the degree have no memory.
    void resize(std::size_t count, std::size_t with_sh, int sh_degree) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            const std::size_t rows = is_view_dependent(p) ? with_sh : count;
            arrays_[p].resize(has_parameter(p, sh_degree) ? in_whole_blocks(rows) * width(p) : 0);
        }
        gaussians_with_sh_ = with_sh;
    }
    void resize(std::size_t count, int sh_degree) { resize(count, count, sh_degree); }
    /// Moves the arrays of this SH degree and above to host memory, and the others to device memory. Keeps
    /// the contents. Precondition: the degree is at least 1.
    void move_to_host_from(Device& device, int sh_degree) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            const auto place =
                has_parameter(p, sh_degree - 1) ? device::memory_place::device : device::memory_place::host;
            if (place == places_[p]) continue;
            buffer moved;
            moved.free_in(place);
            moved.resize(arrays_[p].size());
            if (moved.size() > 0) device.copy(moved.data(), arrays_[p].data(), moved.size());
            arrays_[p] = std::move(moved);
            places_[p] = place;
        }
    }
    /// Reserves device memory for a cache with this number of slots for blocks of all SH coefficients above
    /// degree 0, or frees it. `slot_of`: see `parameter_arrays::cache_slot`.
    void reserve_cache(std::size_t slots, const std::uint32_t* slot_of) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            const bool is_in_cache = is_view_dependent(p) && arrays_[p].size() > 0;
            const std::size_t n = is_in_cache ? slots * block_length * width(p) : 0;
            if (n < cached_[p].size()) cached_[p] = {};
            cached_[p].resize(n);
        }
        cache_slot_ = slots > 0 ? slot_of : nullptr;
    }
    /// Returns whether an array lies in host memory.
    bool is_on_host() const {
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (places_[p] == device::memory_place::host && arrays_[p].size() > 0) return true;
        return false;
    }
    /// Calls f(array, cached, width) for each array with blocks in the cache.
    template <class F>
    void for_each_cached(const F& f) const {
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (cached_[p].size() > 0) f(arrays_[p].data(), cached_[p].data(), width(p));
    }
    /// Frees the memory of one array, or of all.
    /// @{
    void free(std::size_t p) { arrays_[p].free_in(places_[p]); }
    void free() {
        for (std::size_t p = 0; p < parameter_count; ++p) free(p);
        gaussians_with_sh_ = 0;
    }
    /// @}
    /// Changes the SH degree and keeps the contents. Frees the coefficients above degree `to`; new
    /// coefficients above degree `from` are zero.
    void change_sh_degree(Device& device, int from, int to) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            if (has_parameter(p, from) == has_parameter(p, to)) continue;
            free(p);
            if (!has_parameter(p, to)) continue;
            arrays_[p].resize(in_whole_blocks(gaussians_with_sh_) * width(p));
            device.zero(arrays_[p].data(), arrays_[p].size());
        }
    }
    buffer& operator[](std::size_t p) { return arrays_[p]; }
    /// Gets or sets `parameter_arrays::gaussians_with_sh`. Set it when you resize the arrays.
    /// @{
    std::size_t gaussians_with_sh() const { return gaussians_with_sh_; }
    void set_gaussians_with_sh(std::size_t count) { gaussians_with_sh_ = count; }
    /// @}

    parameter_arrays<const T> read() const { return pointers<const T>(); }
    parameter_arrays<T> write() { return pointers<T>(); }

    void zero(Device& device) {
        for (auto& a : arrays_) device.zero(a.data(), a.size());
    }
    /// Appends all arrays, for `device::gather`.
    void share(std::vector<ranks::shared_array>& arrays) const {
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (arrays_[p].size() > 0)
                arrays.push_back(
                    ranks::shared_array::of(arrays_[p].data(), block_length * width(p), arrays_[p].size()));
    }
    /// Saves or loads all arrays. Waits for the device.
    void exchange(state_archive& archive, Device& device) {
        for (std::size_t p = 0; p < parameter_count; ++p)
            exchange_buffer(archive, device, parameter_names[p], arrays_[p]);
        archive.exchange("gaussians_with_sh", gaussians_with_sh_);
    }
    /// Returns whether the arrays have the sizes for this number of Gaussians and this SH degree.
    bool fits(std::size_t count, int sh_degree) const {
        bool fits = gaussians_with_sh_ == count ||
                    (gaussians_with_sh_ < count && gaussians_with_sh_ % block_length == 0);
        for (std::size_t p = 0; p < parameter_count; ++p) {
            const std::size_t rows = is_view_dependent(p) ? gaussians_with_sh_ : count;
            fits = fits &&
                   arrays_[p].size() == (has_parameter(p, sh_degree) ? in_whole_blocks(rows) * width(p) : 0);
        }
        return fits;
    }
    /// Resizes the arrays and copies the model to them. An empty `sh_rest` means zeros. Waits for the device.
    void upload(Device& device, const gaussians& model) {
        resize(model.count(), model.sh_degree);
        for_each_part(
            model, [&](parameter p, const std::vector<float>& from, std::size_t stride, std::size_t first) {
                if (&from == &model.sh_rest && from.empty()) {
                    auto& zeros = arrays_[static_cast<std::size_t>(p)];
                    device.zero(zeros.data(), zeros.size());
                    return;
                }
                const auto blocks = to_blocks(from.data() + first, model.count(), stride, width_of(p));
                buffer& to = arrays_[static_cast<std::size_t>(p)];
                device.upload(to.data(), blocks.data(), blocks.size());
                device.wait();
            });
    }
    /// Returns the first `count` Gaussians as a model. SH coefficients that a Gaussian does not
    /// have are zero. Waits for the device.
    gaussians download(Device& device, std::size_t count, int sh_degree) const {
        gaussians model;
        model.sh_degree = sh_degree;
        model.mean.resize(3 * count);
        model.log_scale.resize(3 * count);
        model.quaternion.resize(4 * count);
        model.opacity.resize(count);
        model.sh_constant.resize(3 * count);
        model.sh_rest.resize(static_cast<std::size_t>(model.rest_width()) * count);
        for_each_part(model, [&](parameter p, std::vector<float>& to, std::size_t stride, std::size_t first) {
            const buffer& from = arrays_[static_cast<std::size_t>(p)];
            std::vector<float> blocks(from.size());
            device.download(blocks.data(), from.data(), blocks.size());
            const std::size_t rows =
                is_view_dependent(static_cast<std::size_t>(p)) ? gaussians_with_sh_ : count;
            from_blocks(blocks.data(), rows, stride, width_of(p), to.data() + first);
        });
        return model;
    }

  private:
    /// Calls f(parameter, values, stride, first) for each parameter of a model. The parameter
    /// begins at index `first` of each row of `stride` values.
    template <class Model, class F>
    static void for_each_part(Model& model, const F& f) {
        f(parameter::mean, model.mean, 3, 0);
        f(parameter::log_scale, model.log_scale, 3, 0);
        f(parameter::quaternion, model.quaternion, 4, 0);
        f(parameter::opacity, model.opacity, 1, 0);
        f(parameter::sh0, model.sh_constant, 3, 0);
        for (int band = 1; band <= model.sh_degree; ++band)
            f(sh_band(band), model.sh_rest, static_cast<std::size_t>(model.rest_width()),
              static_cast<std::size_t>(3 * (sh_coefficients(band - 1) - 1)));
    }

    template <class Real>
    parameter_arrays<Real> pointers() const {
        const auto &a = arrays_, &c = cached_;
        return {a[0].data(),
                a[1].data(),
                a[2].data(),
                a[3].data(),
                {a[4].data(), a[5].data(), a[6].data(), a[7].data(), nullptr, c[5].data(), c[6].data(),
                 c[7].data()},
                gaussians_with_sh_,
                cache_slot_};
    }

    std::array<buffer, parameter_count> arrays_, cached_;
    const std::uint32_t* cache_slot_ = nullptr;
    std::array<device::memory_place, parameter_count> places_{};
    std::size_t gaussians_with_sh_ = 0;
};

}  // namespace gs
