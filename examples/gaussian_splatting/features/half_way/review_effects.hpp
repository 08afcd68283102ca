// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../resolve.hpp"

namespace gs::features {

/// Adds to a training that it reviews, after half of the iterations, the effects that
/// `selected_feature::may_begin`, and simulates those that `feature::review` recommends. Adds nothing if no
/// effect may begin. `features` must outlive the training.
void schedule_review(const feature_set& features, train::training& training);

}  // namespace gs::features
