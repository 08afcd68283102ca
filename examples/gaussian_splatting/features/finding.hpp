// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gs::features {

/// The conclusion about a feature, from the scene statistics or from a half-trained model.
struct finding {
    std::optional<bool> recommended;  ///< empty if the photos do not allow a decision
    std::string evidence;             ///< the reason, with its figures
    std::string choice;               ///< the consequence for training, as `inspect` prints it
    std::vector<float> values{};      ///< initial values of the feature if it is on
    bool if_unknown = false;          ///< whether to simulate it if `recommended` is empty
};

/// A feature in one training run.
struct selected_feature {
    std::string name;
    bool on = false;
    std::string reason;
    std::vector<float> values{};  ///< initial values if it is on: see each feature
    bool may_begin = false;       ///< whether it is off but training may find half-way that it is needed
};

}  // namespace gs::features
