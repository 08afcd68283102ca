// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../device/device.hpp"
#include "../render/renderer.hpp"

namespace gs::train {

/// Notes how long the lists of a view are. One index.
struct note_length {
    raster::list_capacity capacity;
    std::uint64_t* length;

    WARPAGG_HD void operator()(std::size_t) const { *length = *capacity.required; }
};

/// Remembers how long the tile lists of each training view were, and sizes the renderer's memory for the
/// longest.
template <device::device Device>
class list_sizer {
  public:
    explicit list_sizer(Device& device) : device_(device) {}

    /// Forgets all lengths.
    void reset(std::size_t views) {
        lengths_.resize(views);
        counts_.assign(views, 0);
    }
    /// Where a step notes the length of its view's lists, in memory of the device.
    std::uint64_t* length(std::size_t view) { return lengths_.data() + view; }
    /// A step has noted it, with that many Gaussians.
    void was_noted(std::size_t view, std::size_t gaussians) { counts_[view] = gaussians; }

    /// Makes room for the longest lists, and for what they may grow to. Measures views that no step has seen.
    /// Waits for the device.
    template <class Renderer, class Views>
    void reserve(Renderer& renderer, const typename Renderer::model& model, std::size_t gaussians,
                 const Views& views) {
        for (std::size_t v = 0; v < views.size(); ++v) {
            if (counts_[v] > 0) continue;
            renderer.measure(model, gaussians, views[v].camera, 0);  // colors do not matter
            device_.for_each_index(1, note_length{renderer.capacity(), length(v)});
            counts_[v] = gaussians;
        }
        std::vector<std::uint64_t> lengths(views.size());
        if (!lengths.empty()) device_.download(lengths.data(), lengths_.data(), lengths.size());
        std::uint64_t longest = 0;
        double expected = 0;
        for (std::size_t v = 0; v < lengths.size(); ++v) {
            longest = std::max(longest, lengths[v]);
            if (lengths[v] > 0)
                expected =
                    std::max(expected, static_cast<double>(lengths[v]) * static_cast<double>(gaussians) /
                                           static_cast<double>(counts_[v]));
        }
        // With a margin on both sides, so that the memory seldom changes.
        if (static_cast<double>(renderer.reserved_instances()) < 1.5 * expected + 1024)
            renderer.reserve_instances(longest, static_cast<std::uint64_t>(2 * expected) + 4096);
    }

  private:
    Device& device_;
    typename Device::template buffer<std::uint64_t> lengths_;  ///< by training view, when it was last noted
    std::vector<std::size_t> counts_;  ///< of Gaussians at that time; 0 if it was not noted
};

}  // namespace gs::train
