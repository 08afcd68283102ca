// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "raster/renderer.hpp"
#include "render_probe.hpp"
#include "train/photometric.hpp"

namespace probe {

template <class Device, class Real>
answer ask(const question& q) {
    Device device;
    gs::raster::renderer<Device, Real> renderer(device);
    gs::train::photometric<Device, Real> photometric(device);

    std::array<typename Device::template buffer<Real>, gs::parameter_count> values, gradients;
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        const std::vector<Real> host(q.parameters[p].begin(), q.parameters[p].end());
        values[p].resize(host.size());
        gradients[p].resize(host.size());
        if (!host.empty()) device.upload(values[p].data(), host.data(), host.size());
        device.wait();
    }
    const auto arrays = [](const auto& a) {
        return gs::parameter_arrays<Real>{a[0].data(),
                                          a[1].data(),
                                          a[2].data(),
                                          a[3].data(),
                                          {a[4].data(), a[5].data(), a[6].data(), a[7].data()}};
    };
    const auto v = arrays(values);
    const gs::parameter_arrays<const Real> model{
        v.mean, v.log_scale, v.quaternion, v.opacity, {v.sh[0], v.sh[1], v.sh[2], v.sh[3]}};

    const gs::camera& camera = q.view.camera;
    renderer.reserve_instances(renderer.count_instances(model, q.count(), camera, q.sh_degree));
    renderer.forward(model, q.count(), camera, q.sh_degree, q.background);

    typename Device::template buffer<std::uint8_t> photo;
    photo.resize(q.view.pixels.rgba.size());
    device.upload(photo.data(), q.view.pixels.rgba.data(), photo.size());
    photometric.set_photo(photo.data(), camera.width, camera.height, q.background);
    renderer.backward(photometric.gradient(renderer.picture(), 0.2), q.policy, arrays(gradients), nullptr);

    answer a;
    std::vector<Real> picture(3 * static_cast<std::size_t>(camera.width) *
                              static_cast<std::size_t>(camera.height));
    device.download(picture.data(), renderer.picture(), picture.size());
    a.picture.assign(picture.begin(), picture.end());
    a.loss = photometric.take().loss(0.2);
    for (std::size_t p = 0; p < gs::parameter_count; ++p) {
        std::vector<Real> host(gradients[p].size());
        if (!host.empty()) device.download(host.data(), gradients[p].data(), host.size());
        a.gradients[p].assign(host.begin(), host.end());
    }
    return a;
}

}  // namespace probe
