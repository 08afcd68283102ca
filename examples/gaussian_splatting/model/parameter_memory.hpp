// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "../checkpoint/state_archive.hpp"
#include "../device/device.hpp"
#include "aosoa.hpp"
#include "gaussians.hpp"
#include "parameters.hpp"

namespace gs {

/// The arrays that ranks divide, so that each has the elements of its own Gaussians only.
enum class divided_arrays {
    view_dependent,  ///< the SH coefficients above degree 0, which take most of the memory
    all
};

/// Arrays in device memory, one per parameter, with `Widths` elements for each Gaussian, by parameter:
/// as many as the parameter has components, or another number for data about parameters. Their layout
/// is AoSoA: see `aosoa_index`. Several ranks can divide arrays. Pointers to a divided array point to its
/// beginning as if it was whole, so kernels use the same indices.
template <device::device Device, class T = float, const auto& Widths = parameter_width>
class parameter_memory {
  public:
    using buffer = typename Device::template buffer<T>;

    explicit parameter_memory(divided_arrays divides = divided_arrays::all) : divides_(divides) {}

    /// Returns the number of elements of a parameter for each Gaussian.
    static constexpr std::size_t width(std::size_t p) { return static_cast<std::size_t>(Widths[p]); }

    /// Sets the number of Gaussians, of those with SH coefficients above degree 0, and the SH degree.
    /// Loses the contents. SH coefficients above the degree have no memory.
    void resize(std::size_t count, std::size_t with_sh, int sh_degree) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            const std::size_t rows = is_view_dependent(p) ? with_sh : count;
            resize_array(p, has_parameter(p, sh_degree) ? in_whole_blocks(rows) * width(p) : 0);
        }
        gaussians_with_sh_ = with_sh;
    }
    void resize(std::size_t count, int sh_degree) { resize(count, count, sh_degree); }
    /// Sets the number of elements of one array, of all ranks together. Loses its contents.
    void resize_array(std::size_t p, std::size_t elements) {
        whole_[p] = elements;
        const ranks::share part = part_of(p, elements, own_);
        if (part.count() < arrays_[p].size()) arrays_[p].free_in(places_[p]);
        arrays_[p].resize(part.count());
    }
    /// Divides the arrays, so that this rank has the elements of these Gaussians, which consist of whole
    /// blocks. Nothing means all Gaussians. Keeps the contents of elements that it had and will have.
    void divide(Device& device, const std::optional<ranks::share>& own) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            const ranks::share before = part(p), after = part_of(p, whole_[p], own);
            if (before == after) continue;
            buffer moved;
            moved.free_in(places_[p]);
            moved.resize(after.count());
            const std::size_t first = std::max(before.first, after.first),
                              last = std::min(before.last, after.last);
            if (first < last)
                device.copy(moved.data() + (first - after.first), arrays_[p].data() + (first - before.first),
                            last - first);
            arrays_[p] = std::move(moved);
        }
        own_ = own;
    }
    /// Returns whether this rank may lack elements of an array, or of any.
    /// @{
    bool is_divided(std::size_t p) const { return own_ && divides(p); }
    bool is_divided() const { return own_.has_value(); }
    /// @}
    /// Returns the elements of an array that this rank has, or would have if the array had this number of
    /// elements and these were its Gaussians.
    /// @{
    ranks::share part(std::size_t p) const { return part_of(p, whole_[p], own_); }
    ranks::share part_of(std::size_t p, std::size_t elements, const std::optional<ranks::share>& own) const {
        if (!own || !divides(p)) return {0, elements};
        return {std::min(in_whole_blocks(own->first) * width(p), elements),
                std::min(in_whole_blocks(own->last) * width(p), elements)};
    }
    /// @}
    /// Replaces an array by `elements` others, of which this rank has these. Call `set_division` after the
    /// last array, with the Gaussians of this rank.
    /// @{
    void replace(Device& device, std::size_t p, std::size_t elements, const buffer& part) {
        whole_[p] = elements;
        if (part.size() < arrays_[p].size()) arrays_[p].free_in(places_[p]);
        arrays_[p].resize(part.size());
        device.copy(arrays_[p].data(), part.data(), part.size());
    }
    void set_division(const std::optional<ranks::share>& own) { own_ = own; }
    /// @}
    /// Returns the number of elements of an array, of all ranks together.
    std::size_t elements(std::size_t p) const { return whole_[p]; }
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
    /// Frees the memory of all arrays.
    void free() {
        for (std::size_t p = 0; p < parameter_count; ++p) resize_array(p, 0);
        gaussians_with_sh_ = 0;
    }
    /// Changes the SH degree and keeps the contents. Frees the coefficients above degree `to`; new
    /// coefficients above degree `from` are zero.
    void change_sh_degree(Device& device, int from, int to) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            if (has_parameter(p, from) == has_parameter(p, to)) continue;
            resize_array(p, has_parameter(p, to) ? in_whole_blocks(gaussians_with_sh_) * width(p) : 0);
            device.zero(arrays_[p].data(), arrays_[p].size());
        }
    }
    /// The elements of an array that this rank has.
    const buffer& operator[](std::size_t p) const { return arrays_[p]; }
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
    /// Appends the arrays that ranks divide, or the others, for `device::gather`. Precondition: this
    /// rank has all elements of these.
    void share(bool divided, std::vector<ranks::shared_array>& arrays) const {
        for (std::size_t p = 0; p < parameter_count; ++p)
            if (divides(p) == divided && arrays_[p].size() > 0)
                arrays.push_back(
                    ranks::shared_array::of(arrays_[p].data(), block_length * width(p), arrays_[p].size()));
    }
    /// Saves or loads all arrays, and those of all ranks if they are divided. All ranks must call this.
    /// Waits for the device.
    void exchange(state_archive& archive, Device& device) {
        for (std::size_t p = 0; p < parameter_count; ++p) {
            std::vector<T> elements;
            if (!archive.loads()) elements = downloaded(device, p);
            archive.exchange(parameter_names[p], elements);
            if (!archive.loads()) continue;
            resize_array(p, elements.size());
            device.upload(arrays_[p].data(), elements.data() + part(p).first, arrays_[p].size());
            device.wait();
        }
        archive.exchange("gaussians_with_sh", gaussians_with_sh_);
    }
    /// Returns whether the arrays have the sizes for this number of Gaussians and this SH degree.
    bool fits(std::size_t count, int sh_degree) const {
        bool fits = gaussians_with_sh_ == count ||
                    (gaussians_with_sh_ < count && gaussians_with_sh_ % block_length == 0);
        for (std::size_t p = 0; p < parameter_count; ++p) {
            const std::size_t rows = is_view_dependent(p) ? gaussians_with_sh_ : count;
            fits = fits && whole_[p] == (has_parameter(p, sh_degree) ? in_whole_blocks(rows) * width(p) : 0);
        }
        return fits;
    }
    /// Resizes the arrays, which are not divided afterwards, and copies the model to them. An empty `sh_rest`
    /// means zeros. Waits for the device.
    void upload(Device& device, const gaussians& model) {
        own_.reset();
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
    /// have are zero. All ranks must call this if arrays are divided. Waits for the device.
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
            const std::vector<float> blocks = downloaded(device, static_cast<std::size_t>(p));
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

    bool divides(std::size_t p) const { return divides_ == divided_arrays::all || is_view_dependent(p); }
    /// Returns all elements of an array, with those of other ranks.
    std::vector<T> downloaded(Device& device, std::size_t p) const {
        std::vector<T> all(whole_[p]);
        const ranks::share own = part(p);
        if (own.count() > 0) device.download(all.data() + own.first, arrays_[p].data(), own.count());
        if (!is_divided(p)) return all;
        std::vector<std::uint64_t> counts(static_cast<std::size_t>(device.ranks().count()));
        counts[static_cast<std::size_t>(device.ranks().rank())] = own.count();
        device.ranks().sum(counts.data(), counts.size());
        const auto array = ranks::shared_array::of(all.data(), 1, all.size());
        device.ranks().gather(ranks::shares(std::vector<std::size_t>(counts.begin(), counts.end())),
                              {&array, 1});
        return all;
    }
    /// Returns where an array would begin if this rank had all of it.
    T* begin(std::size_t p) const {
        return arrays_[p].size() > 0 ? arrays_[p].data() - part(p).first : nullptr;
    }
    template <class Real>
    parameter_arrays<Real> pointers() const {
        const auto& c = cached_;
        return {begin(0),
                begin(1),
                begin(2),
                begin(3),
                {begin(4), begin(5), begin(6), begin(7), nullptr, c[5].data(), c[6].data(), c[7].data()},
                gaussians_with_sh_,
                cache_slot_};
    }

    divided_arrays divides_;
    std::optional<ranks::share> own_;  ///< the Gaussians of this rank, or nothing if it has all elements
    std::array<std::size_t, parameter_count> whole_{};  ///< elements of each array, of all ranks together
    std::array<buffer, parameter_count> arrays_, cached_;
    const std::uint32_t* cache_slot_ = nullptr;
    std::array<device::memory_place, parameter_count> places_{};
    std::size_t gaussians_with_sh_ = 0;
};

}  // namespace gs
