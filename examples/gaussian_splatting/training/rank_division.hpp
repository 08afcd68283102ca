// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "../densify/parameter_gather.hpp"
#include "../device/device.hpp"
#include "../model/gaussian_shares.hpp"
#include "../optimize/trained_parameters.hpp"
#include "../render/project/project_backward.hpp"

namespace gs::train {

/// Divides the Gaussians in training among the ranks. With one rank, all functions do nothing; with several,
/// all ranks must call them.
template <device::device Device>
class rank_division {
  public:
    /// All arguments must exist as long as this object.
    rank_division(Device& device, trained_parameters<Device>& trained,
                  const typename Device::template buffer<raster::visibility>& seen)
        : device_(device), trained_(trained), seen_(seen) {}

    /// Returns the part of `count` Gaussians that this rank has. It is 1 with one rank.
    double own_part(std::size_t count) const {
        if (!trained_.shares || count == 0) return 1.0 / ranks();
        return static_cast<double>(trained_.own(device_, count).count()) / static_cast<double>(count);
    }
    /// Returns the object that decides which Gaussians each rank has.
    const gaussian_shares& shares() const { return shares_; }
    /// Records that all ranks have the same new Gaussians.
    void reset() { is_up_to_date_ = true; }
    /// Leaves this rank its own part of `count` Gaussians that it has. Also gives all renderers the same
    /// capacity for tile lists, because ranks render different views when they have all Gaussians.
    template <class Renderer>
    void divide(std::size_t count, Renderer& renderer) {
        if (ranks() == 1 || trained_.values.is_divided()) return;
        std::uint64_t capacity = renderer.reserved_instances();
        device_.ranks().maximum(&capacity, 1);
        if (capacity > renderer.reserved_instances()) renderer.reserve_instances(capacity);
        trained_.divide(device_, trained_.shares.value_or(shares_.of(count, ranks())));
    }
    /// Divides memory for other Gaussians, which a checkpoint contains. All ranks load it.
    void divide_for_loading(std::size_t count) {
        if (ranks() > 1) trained_.divide(device_, shares_.of(count, ranks()));
        reset();
    }
    /// Records a step with a view that showed these Gaussians of each rank.
    void note_step(const ranks::shares& shown, std::size_t count) {
        shares_.note(shown, count, ranks());
        note_change();
    }
    /// Records that each rank has changed its own Gaussians.
    void note_change() { is_up_to_date_ = !trained_.shares; }
    /// Gives all ranks the present values and statistics of all Gaussians, apart from divided arrays.
    void update() {
        if (is_up_to_date_) return;
        trained_.update_values(device_);
        const ranks::shared_array array[] = {
            ranks::shared_array::of(seen_.data(), block_length, seen_.size())};
        device_.gather(*trained_.shares, array);
        is_up_to_date_ = true;
    }
    /// See `gaussian_shares`. The Gaussians follow in the next `move`.
    void balance() { shares_.balance(); }
    /// Moves the Gaussians to the ranks that `shares` gives them. Precondition: `update`.
    void move(std::size_t count, int sh_degree, parameter_gather<Device>& gather) {
        if (!trained_.shares || *trained_.shares == shares_.of(count, ranks())) return;
        gather.keep_all(count);
        gather.run(trained_, count, trained_.values.gaussians_with_sh(), sh_degree);
    }
    /// The same after `balance`, if a rank has clearly more work than others.
    void move_if_uneven(std::size_t count, int sh_degree, parameter_gather<Device>& gather) {
        if (!shares_.are_uneven()) return;
        update();
        balance();
        move(count, sh_degree, gather);
    }

  private:
    int ranks() const { return device_.ranks().count(); }

    Device& device_;
    trained_parameters<Device>& trained_;
    const typename Device::template buffer<raster::visibility>& seen_;
    gaussian_shares shares_;
    bool is_up_to_date_ = true;  ///< whether `update` has nothing to do
};

}  // namespace gs::train
