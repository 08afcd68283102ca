// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "backend.hpp"
#include "densify/adaptive/densify_kernels.hpp"
#include "losses/l1_ssim/l1_ssim.hpp"
#include "memory_on.hpp"
#include "optimize/adam.hpp"

namespace hard_cases {

/// Adam alone, with gradients from an array: opacities, a Gaussian a lane.
template <class W>
struct descend_row {
    gs::train::adam<float> step;
    const float* gradients;
    const std::uint32_t* takes_part;
    std::size_t count;

    WARPAGG_HD void operator()(const W& w, unsigned warp_index) const {
        using warpagg::value_t;
        const std::size_t first = std::size_t{warp_index} * W::size;
        const auto inside = w.lane() + static_cast<unsigned>(first) < static_cast<unsigned>(count);
        const auto part = w.load_row(takes_part, static_cast<std::ptrdiff_t>(first), inside);
        const gs::raster::gaussian_row<W> row{first, inside, inside && part != value_t<W, unsigned>(0)};
        const auto opacity = row.template load<1>(w, step.values.opacity, 0, 1);
        const auto gradient = row.template load<1>(w, gradients, 0, 1);
        step.for_row(w, row)(gs::parameter::opacity, 0, 1, opacity, gradient);
    }
};

/// The training operations of a backend.
template <class Device, class Real>
class training_on {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using memory = memory_on<Device, Real>;

  public:
    static compare_result compare(const compare_case& q) {
        Device device;
        memory on(device);
        gs::train::l1_ssim<Device, Real> loss(device);
        gs::train::image_comparison<Device, Real> comparison(device);
        buffer<std::uint8_t> photo;
        buffer<Real> render;
        on.put_bytes(photo, q.rgba);
        on.put(render, q.render);
        const gs::train::target_image target{photo.data(), q.width, q.height, q.background};
        loss.set_target(target);
        comparison.set_target(target);
        comparison.compare(render.data());
        compare_result a;
        a.gradient = on.get(loss.gradient(render.data(), {}), q.render.size());
        a.loss = loss.take().loss;
        a.quality = comparison.take();
        return a;
    }

    static std::vector<std::vector<double>> descend(const std::vector<std::vector<double>>& gradients,
                                                    double rate,
                                                    const std::vector<std::vector<std::uint32_t>>& takes_part,
                                                    std::uint32_t steps_before) {
        using adam = gs::train::adam<float>;
        Device device;
        memory_on<Device, float> on(device);
        using warp = typename Device::narrow_warp;
        const std::size_t n = gradients.front().size(), places = gs::in_whole_blocks(n);
        buffer<float> values, first, second, gradient;
        for (auto* b : {&values, &first, &second}) on.put(*b, std::vector<double>(places, 0.0));
        buffer<std::uint32_t> part, last_step;
        on.put_as_they_are(last_step, std::vector<std::uint32_t>(places, 0));
        buffer<gs::train::finite_check::memory> found;
        on.put_as_they_are(found, std::vector{gs::train::finite_check::clean()});
        std::vector<std::vector<double>> path;
        for (auto g : gradients) {
            g.resize(places);
            on.put(gradient, g);
            auto who = takes_part.empty() ? std::vector<std::uint32_t>(n, 1) : takes_part[path.size()];
            who.resize(places);
            on.put_as_they_are(part, who);
            adam step{};
            step.last_step = last_step.data();
            step.step = steps_before + static_cast<std::uint32_t>(path.size()) + 1;
            const auto t = static_cast<double>(step.step);
            step.check.found = found.data();
            step.values.opacity = values.data();
            step.moments.first.opacity = first.data();
            step.moments.second.opacity = second.data();
            step.rates[static_cast<int>(gs::parameter::opacity)] =
                static_cast<float>(rate / (1 - std::pow(adam::beta1, t)));
            step.correction = static_cast<float>(1 / std::sqrt(1 - std::pow(adam::beta2, t)));
            device.template for_each_warp<warp>((n + warp::size - 1) / warp::size,
                                                descend_row<warp>{step, gradient.data(), part.data(), n});
            path.push_back(on.get(values.data(), n));
        }
        return path;
    }

    static judgment judge(const std::vector<sighting>& sightings, const std::vector<double>& opacities,
                          const gs::train::densify_config& config) {
        Device device;
        memory_on<Device, float> on(device);
        const std::size_t n = sightings.size();
        std::vector<gs::raster::visibility> host;
        for (const sighting& s : sightings)
            host.push_back({static_cast<float>(s.gradient), static_cast<float>(s.seen)});
        buffer<gs::raster::visibility> seen;
        buffer<float> log_scale, opacity;
        buffer<std::uint32_t> stays, large, urgency, identities;
        buffer<unsigned long long> without_gradient;
        on.put_as_they_are(seen, host);
        on.put(log_scale, std::vector<double>(3 * gs::in_whole_blocks(n), -3.0));
        on.put(opacity, opacities);
        for (auto* b : {&stays, &large, &urgency, &identities}) b->resize(n);
        without_gradient.resize(1);
        device.zero(without_gradient.data(), 1);
        gs::parameter_arrays<const float> model;
        model.log_scale = log_scale.data();
        model.opacity = opacity.data();
        device.for_each_index(n, gs::train::classify{model,
                                                     seen.data(),
                                                     config,
                                                     {stays.data(), large.data(), urgency.data(),
                                                      identities.data(), without_gradient.data()}});
        return {on.get_as_they_are(stays.data(), n), on.get_as_they_are(urgency.data(), n),
                on.get_as_they_are(without_gradient.data(), 1)[0]};
    }
};

}  // namespace hard_cases
