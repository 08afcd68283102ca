// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../checkpoint/state_archive.hpp"
#include "../ranks/communicator.hpp"

namespace gs::train {

/// Counts the pixel-Gaussian pairs of training steps, but not those of other renders: see
/// `raster::renderer::pairs`.
template <class Renderer>
class pair_counter {
  public:
    pair_counter(typename Renderer::device_type& device, const Renderer& renderer)
        : device_(device), renderer_(renderer) {}

    /// Returns the pairs of this rank's steps, and those of others at the last `take_others`. Waits for the
    /// device, like the next functions.
    std::uint64_t of_steps() { return own() + of_others_; }
    /// Returns the pairs of all renders of this rank.
    std::uint64_t of_renders() {
        unsigned long long n = 0;
        device_.download(&n, renderer_.pairs(), 1);
        return n;
    }
    /// Leaves out the pairs of a render that is no step, since `of_renders` was `before`.
    void leave_out_since(std::uint64_t before) { left_out_ += of_renders() - before; }
    /// Adds the pairs of the other ranks. All ranks must call this.
    void take_others() {
        std::uint64_t pairs = own();
        device_.ranks().sum(&pairs, 1);
        of_others_ = pairs - own();
    }
    void exchange(state_archive& archive) {
        std::uint64_t pairs = of_steps();
        archive.exchange("pairs", pairs);
        if (!archive.loads()) return;
        left_out_ = of_renders() - (device_.ranks().is_first() ? pairs : 0);
        of_others_ = 0;
    }

  private:
    std::uint64_t own() { return of_renders() - left_out_; }

    typename Renderer::device_type& device_;
    const Renderer& renderer_;
    std::uint64_t left_out_ = 0, of_others_ = 0;
};

}  // namespace gs::train
