// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "../../scene/scene.hpp"

namespace gs::features {

/// Divides the training views into groups whose photos have the same falloff: the same kind of lens, almost
/// the same focal length and almost the same size, upright or not. Panoramas are in no group, because
/// software has stitched them from several photos.
class lens_groups {
  public:
    explicit lens_groups(const std::vector<view>& training);

    /// Returns the number of groups.
    std::size_t count() const { return first_.size(); }
    /// Returns the group to which a camera fits, or nothing.
    std::optional<std::size_t> of(const camera& c) const;
    /// Returns the camera that began a group.
    const camera& first(std::size_t group) const { return first_[group]; }

  private:
    std::vector<camera> first_;
};

}  // namespace gs::features
