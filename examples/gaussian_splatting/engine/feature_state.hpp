// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace gs::train {

/// The state of a feature on the device, as the host sees it.
class feature_state {
  public:
    virtual ~feature_state() = default;

    /// Sets the initial values of the feature, and Adam's moments to zero.
    virtual void set_values(const std::vector<float>&) {}
    /// Changes the values during training, and keeps Adam's moments.
    virtual void change_values(const std::vector<float>&) {}
    /// Returns the learned values. Waits for the device.
    virtual std::vector<float> values() const { return {}; }
    /// Sets the values for held-out views. An empty list leaves their renders unchanged.
    virtual void set_held_out_values(const std::vector<float>&) {}
    /// Removes the ambiguity between the values and the model, without changing any render.
    virtual void normalize() {}
};

}  // namespace gs::train
