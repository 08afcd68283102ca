// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "lists_on.hpp"
#include "renders_on.hpp"
#include "training_on.hpp"

namespace hard_cases {

/// The kernels on this device, in this precision.
template <class Device, class Real>
backend make_backend(const char* name) {
    using renders = renders_on<Device, Real>;
    using lists = lists_on<Device, Real>;
    using training = training_on<Device, Real>;
    return {name,
            Device::warp::size,
            [] { return Device().name(); },
            renders::render,
            renders::loss,
            renders::project,
            lists::blend,
            training::compare,
            training::descend,
            training::judge,
            lists::prefix_sum,
            lists::sort,
            lists::distribute,
            renders::complaint_about_instances,
            lists::sum};
}

}  // namespace hard_cases
