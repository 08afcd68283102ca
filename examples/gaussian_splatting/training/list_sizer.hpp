// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../checkpoint/exchange_buffer.hpp"
#include "../core/error.hpp"
#include "../device/device.hpp"
#include "../render/renderer.hpp"

namespace gs::train {

/// Records the length of a view's tile lists, or the mean length of several views. One index.
struct note_length {
    raster::list_capacity capacity;
    std::uint64_t* length;
    std::uint64_t views = 1;

    WARPAGG_HD void operator()(std::size_t) const { *length = (*capacity.required + views - 1) / views; }
};

/// Records the length of each training view's tile lists, and sets the capacity of the renderer for the
/// longest ones. A length is the number of instances (Gaussian, tile) of a view.
template <device::device Device>
class list_sizer {
  public:
    explicit list_sizer(Device& device) : device_(device) {}

    /// Clears all lengths, and sets the number of views.
    void reset(std::size_t views) {
        lengths_.resize(views);
        counts_.assign(views, 0);
    }
    /// Saves or loads the lengths. Waits for the device.
    void exchange(state_archive& archive) {
        const std::size_t views = counts_.size();
        exchange_buffer(archive, device_, "lengths", lengths_);
        archive.exchange("counts", counts_);
        if (counts_.size() != views || lengths_.size() != views)
            throw error("the checkpoint has lengths of tile lists that do not fit its views");
    }
    /// Returns the address in device memory where a step stores the length of this view.
    std::uint64_t* length(std::size_t view) { return lengths_.data() + view; }
    /// Records that a step with this number of Gaussians has stored the length of this view.
    void was_noted(std::size_t view, std::size_t gaussians) { counts_[view] = gaussians; }
    /// Stores the mean length of some views that the renderer has drawn as one picture.
    template <class Renderer>
    void note_mean(const Renderer& renderer, std::size_t view) {
        device_.for_each_index(1, note_length{renderer.capacity(), length(view), renderer.views().count()});
    }
    /// Sets the number of views whose lists must fit together.
    void set_views_at_once(std::size_t views) { at_once_ = views; }

    /// Sets the capacity for the longest lists, with a reserve for growth. Measures views whose
    /// length is unknown. Waits for the device.
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
        longest *= at_once_;
        expected *= static_cast<double>(at_once_);
        // The new memory exceeds the tested one, so that it seldom changes.
        if (static_cast<double>(renderer.reserved_instances()) < 1.5 * expected + 1024)
            renderer.reserve_instances(longest, static_cast<std::uint64_t>(2 * expected) - longest + 4096);
    }

  private:
    Device& device_;
    typename Device::template buffer<std::uint64_t> lengths_;  ///< last stored length of each view
    std::size_t at_once_ = 1;
    std::vector<std::size_t> counts_;  ///< number of Gaussians at that time; 0: unknown length
};

}  // namespace gs::train
