// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace gs::train {

/// The state of a feature on the device, as the host sees it.
class feature_state {
  public:
    virtual ~feature_state() = default;

    /// What the feature begins from. Its gradients' moments become zero.
    virtual void set_values(const std::vector<float>&) {}
    /// What it has learned. Waits for the device.
    virtual std::vector<float> values() const { return {}; }
    /// What held-out views are shown with; an empty list means as they are rendered.
    virtual void set_held_out_values(const std::vector<float>&) {}
    /// Removes what the values and the scene can exchange without changing any render.
    virtual void normalize() {}
};

}  // namespace gs::train
