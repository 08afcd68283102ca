// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "backend.hpp"
#include "memory_on.hpp"
#include "raster/renderer.hpp"
#include "raster/with_policy.hpp"
#include "train/adam.hpp"
#include "train/densify.hpp"
#include "train/photometric.hpp"

namespace hard_cases {

/// The gradient by the picture, pixel by pixel more or less of it.
template <class Real>
struct weigh_pixels {
    const Real* gradient;
    const Real* weights;
    std::size_t pixels;
    Real* weighed;

    WARPAGG_HD void operator()(std::size_t i) const { weighed[i] = gradient[i] * weights[i % pixels]; }
};

/// Sums 32 values, or one, into one address.
template <class Real, class Policy>
struct sum_values {
    const Real* values;
    unsigned count;
    Real* to;

    template <class W>
    WARPAGG_HD void operator()(const W& w, unsigned index) const {
        const auto place = w.lane() + index * W::size;
        const warpagg::mask_t<W> active = place < count;
        const warpagg::value_t<W, Real> one[1] = {w.load(values, place, active)};
        warpagg::warp_reduce_atomic(w, to, one, active, Policy{});
    }
};

/// The implementation of `backend`.
template <class Device, class Real>
class backend_on {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using memory = memory_on<Device, Real>;
    using parameters = std::array<buffer<Real>, gs::parameter_count>;

    struct session {
        Device device;
        memory on{device};
        gs::raster::renderer<Device, Real> renderer{device};
        gs::train::photometric<Device, Real> photometric{device};
        parameters values, gradients;
        buffer<std::uint8_t> photo;

        void draw(const question& q) {
            for (std::size_t p = 0; p < gs::parameter_count; ++p) {
                on.put(values[p], q.parameters[p]);
                gradients[p].resize(q.parameters[p].size());
            }
            const auto model = read(values);
            const gs::camera& camera = q.view.camera;
            // Room to spare, as in training: places that stay empty are part of the lists.
            const std::uint64_t needed = renderer.count_instances(model, q.count(), camera, q.sh_degree);
            renderer.reserve_instances(needed, needed / 2 + 64);
            renderer.forward(model, q.count(), camera, q.sh_degree, q.background);
            on.put_bytes(photo, q.view.pixels.rgba);
            photometric.set_photo(photo.data(), camera.width, camera.height, q.background);
        }
    };

  public:
    static answer ask(const question& q) {
        session s;
        s.draw(q);
        const std::size_t values = 3 * q.pixels();
        const Real* by_picture = s.photometric.gradient(s.renderer.picture(), weight_of_ssim);
        buffer<Real> weights, weighed;
        if (!q.weights.empty()) {
            s.on.put(weights, q.weights);
            weighed.resize(values);
            s.device.for_each_index(
                values, weigh_pixels<Real>{by_picture, weights.data(), q.pixels(), weighed.data()});
            by_picture = weighed.data();
        }
        buffer<gs::raster::visibility> seen;
        seen.resize(q.count());
        s.device.zero(seen.data(), q.count());
        s.renderer.backward(by_picture, q.policy, write(s.gradients), seen.data());

        answer a;
        a.picture = s.on.get(s.renderer.picture(), values);
        a.loss = s.photometric.take().loss(weight_of_ssim);
        for (std::size_t p = 0; p < gs::parameter_count; ++p)
            a.gradients[p] = s.on.get(s.gradients[p].data(), s.gradients[p].size());
        const auto sightings = s.on.get_as_they_are(seen.data(), q.count());
        a.sightings.resize(sightings.size());
        std::ranges::transform(sightings, a.sightings.begin(), [](const gs::raster::visibility& v) {
            return sighting{static_cast<double>(v.gradient), static_cast<double>(v.seen)};
        });
        return a;
    }

    static double loss(const question& q) {
        session s;
        s.draw(q);
        s.photometric.compare(s.renderer.picture());
        return s.photometric.take().loss(weight_of_ssim);
    }

    static std::vector<projected_splat> project(const question& q) {
        Device device;
        memory on(device);
        parameters values;
        for (std::size_t p = 0; p < gs::parameter_count; ++p) on.put(values[p], q.parameters[p]);
        buffer<gs::raster::splat<Real>> splats;
        buffer<gs::raster::tile_box> boxes;
        buffer<std::uint32_t> depths, identities, tiles;
        const std::size_t n = q.count();
        splats.resize(n);
        boxes.resize(n);
        identities.resize(n);
        // What a frame before left there.
        on.put_as_they_are(depths, std::vector<std::uint32_t>(n, 0));
        on.put_as_they_are(tiles, std::vector<std::uint32_t>(n, 1));
        const auto tiles_along = [](int pixels) {
            return static_cast<unsigned>((pixels + gs::raster::tile_size - 1) / gs::raster::tile_size);
        };
        const gs::camera& camera = q.view.camera;
        device.for_each_index(
            n, gs::raster::project<Real>{read(values), gs::raster::for_device<Real>(camera), q.sh_degree,
                                         tiles_along(camera.width), tiles_along(camera.height), splats.data(),
                                         boxes.data(), depths.data(), identities.data(), tiles.data()});
        const auto host = on.get_as_they_are(splats.data(), n);
        const auto depth = on.get_as_they_are(depths.data(), n), met = on.get_as_they_are(tiles.data(), n);
        std::vector<projected_splat> found(n);
        for (std::size_t i = 0; i < n; ++i) {
            const gs::raster::splat<double> s = widen(host[i]);
            found[i] = {met[i] > 0, depth[i], s.x, s.y,   s.reach, s.opacity,
                        s.p,        s.q,      s.r, s.red, s.green, s.blue};
        }
        return found;
    }

    static blend_answer blend(const blend_question& q) {
        using namespace gs::raster;
        Device device;
        memory on(device);
        std::vector<splat<Real>> made;
        for (const flat_splat& s : q.splats) made.push_back(splat_of(s));
        const auto across = static_cast<unsigned>((q.width + tile_size - 1) / tile_size);
        const auto down = static_cast<unsigned>((q.height + tile_size - 1) / tile_size);
        std::vector<std::uint32_t> order;
        std::vector<tile_range> tiles(across * down);
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            tiles[t].begin = static_cast<std::uint32_t>(q.lists.empty() ? 0 : order.size());
            if (!q.lists.empty())
                order.insert(order.end(), q.lists[t].begin(), q.lists[t].end());
            else if (t == 0)
                for (std::uint32_t i = 0; i < made.size(); ++i) order.push_back(i);
            tiles[t].end = static_cast<std::uint32_t>(order.size());
        }

        buffer<splat<Real>> splats;
        buffer<std::uint32_t> gaussian_of, last;
        buffer<tile_range> ranges;
        buffer<Real> picture, transmittance, gradient, sums;
        buffer<unsigned long long> pairs;
        on.put_as_they_are(splats, made);
        on.put_as_they_are(gaussian_of, order);
        on.put_as_they_are(ranges, tiles);
        const auto pixels = static_cast<std::size_t>(q.width) * static_cast<std::size_t>(q.height);
        picture.resize(3 * pixels);
        transmittance.resize(pixels);
        last.resize(pixels);
        pairs.resize(1);
        device.zero(pairs.data(), 1);
        const vec3<Real> background(q.background[0], q.background[1], q.background[2]);
        const std::size_t warps = tiles.size() * patch<typename Device::warp, Real>::per_tile;
        device.for_each_warp(warps, blend_forward<Real>{splats.data(), gaussian_of.data(), ranges.data(),
                                                        across, q.width, q.height, background, picture.data(),
                                                        transmittance.data(), last.data(), pairs.data()});
        blend_answer a;
        a.picture = on.get(picture.data(), 3 * pixels);
        a.transmittance = on.get(transmittance.data(), pixels);
        a.last = on.get_as_they_are(last.data(), pixels);
        if (q.gradient.empty()) return a;

        on.put(gradient, q.gradient);
        sums.resize(made.size() * record_stride);
        device.zero(sums.data(), sums.size());
        gs::raster::with_policy(q.policy, [&](auto policy, auto ask_first) {
            device.for_each_warp(
                warps, blend_backward<Real, decltype(policy), ask_first.value>{
                           splats.data(), gaussian_of.data(), ranges.data(), across, q.width, q.height,
                           background, transmittance.data(), last.data(), gradient.data(), sums.data()});
        });
        const std::vector<double> records = on.get(sums.data(), sums.size());
        static_assert(sum_count == 9);
        a.sums.resize(made.size());
        for (std::size_t i = 0; i < made.size(); ++i)
            std::copy_n(records.data() + i * record_stride, 9, a.sums[i].data());
        return a;
    }

    static compare_answer compare(const compare_question& q) {
        Device device;
        memory on(device);
        gs::train::photometric<Device, Real> photometric(device);
        buffer<std::uint8_t> photo;
        buffer<Real> picture;
        on.put_bytes(photo, q.rgba);
        on.put(picture, q.picture);
        photometric.set_photo(photo.data(), q.width, q.height, q.background);
        const Real* gradient = photometric.gradient(picture.data(), weight_of_ssim);
        compare_answer a;
        a.gradient = on.get(gradient, q.picture.size());
        a.quality = photometric.take();
        return a;
    }

    static std::vector<std::vector<double>> descend(const std::vector<std::vector<double>>& gradients,
                                                    double rate) {
        using adam = gs::train::adam<float>;
        Device device;
        memory_on<Device, float> on(device);
        const std::size_t n = gradients.front().size();
        buffer<float> values, first, second, gradient;
        for (auto* b : {&values, &first, &second}) on.put(*b, std::vector<double>(n, 0.0));
        buffer<gs::train::watch::memory> found;
        on.put_as_they_are(found, std::vector{gs::train::watch::clean()});
        std::vector<std::vector<double>> path;
        for (const auto& g : gradients) {
            on.put(gradient, g);
            const auto t = static_cast<double>(path.size() + 1);
            adam step{};
            step.watch.found = found.data();
            step.width = 1;
            step.values = values.data();
            step.first = first.data();
            step.second = second.data();
            step.gradients = gradient.data();
            step.rate = static_cast<float>(rate / (1 - std::pow(adam::beta1, t)));
            step.correction = static_cast<float>(1 / std::sqrt(1 - std::pow(adam::beta2, t)));
            device.for_each_element(n, step);
            path.push_back(on.get(values.data(), n));
        }
        return path;
    }

    static judgement judge(const std::vector<sighting>& sightings, const std::vector<double>& opacities,
                           const gs::train::densify_rule& rule) {
        Device device;
        memory_on<Device, float> on(device);
        const std::size_t n = sightings.size();
        std::vector<gs::raster::visibility> host;
        for (const sighting& s : sightings)
            host.push_back({static_cast<float>(s.gradient), static_cast<float>(s.seen)});
        buffer<gs::raster::visibility> seen;
        buffer<float> log_scale, opacity;
        buffer<std::uint32_t> stays, large, urgency, identities;
        buffer<unsigned long long> silent;
        on.put_as_they_are(seen, host);
        on.put(log_scale, std::vector<double>(3 * n, -3.0));
        on.put(opacity, opacities);
        for (auto* b : {&stays, &large, &urgency, &identities}) b->resize(n);
        silent.resize(1);
        device.zero(silent.data(), 1);
        gs::parameter_arrays<const float> model;
        model.log_scale = log_scale.data();
        model.opacity = opacity.data();
        device.for_each_index(n,
                              gs::train::judge_gaussians{model, seen.data(), rule, stays.data(), large.data(),
                                                         urgency.data(), identities.data(), silent.data()});
        return {on.get_as_they_are(stays.data(), n), on.get_as_they_are(urgency.data(), n),
                on.get_as_they_are(silent.data(), 1)[0]};
    }

    static std::vector<std::uint64_t> prefix_sum(const std::vector<std::uint32_t>& values) {
        Device device;
        memory on(device);
        buffer<std::uint32_t> in;
        buffer<std::uint64_t> out;
        on.put_as_they_are(in, values);
        out.resize(values.size() + 1);
        device.prefix_sum(in, out, values.size());
        return on.get_as_they_are(out.data(), out.size());
    }

    static std::string complaint_about_instances(std::uint64_t instances) {
        Device device;
        gs::raster::renderer<Device, Real> renderer(device);
        try {
            renderer.reserve_instances(instances);
        } catch (const gs::error& e) {
            return e.what();
        }
        return "";
    }

    static double sum(const std::vector<double>& values, gradient_policy policy) {
        Device device;
        memory on(device);
        buffer<Real> in, to;
        on.put(in, values);
        on.put(to, {0.0});
        constexpr std::size_t lanes = Device::warp::size;
        gs::raster::with_policy(policy, [&](auto p, auto) {
            device.for_each_warp(
                (values.size() + lanes - 1) / lanes,
                sum_values<Real, decltype(p)>{in.data(), static_cast<unsigned>(values.size()), to.data()});
        });
        return on.get(to.data(), 1)[0];
    }

    static backend make(const char* name) {
        return {name,    ask,     loss,  project,    blend,
                compare, descend, judge, prefix_sum, complaint_about_instances,
                sum};
    }

  private:
    static constexpr double weight_of_ssim = 0.2;

    template <class To, class From>
    static gs::parameter_arrays<To> pointers(From& a) {
        return {a[0].data(),
                a[1].data(),
                a[2].data(),
                a[3].data(),
                {a[4].data(), a[5].data(), a[6].data(), a[7].data()}};
    }
    static gs::parameter_arrays<const Real> read(const parameters& a) { return pointers<const Real>(a); }
    static gs::parameter_arrays<Real> write(parameters& a) { return pointers<Real>(a); }

    static gs::raster::splat<Real> splat_of(const flat_splat& s) {
        const auto vector = [](const std::array<double, 3>& v) {
            return glm::vec<3, Real>(glm::dvec3(v[0], v[1], v[2]));
        };
        const gs::raster::ellipse<Real> shape(vector(s.across), vector(s.down));
        gs::raster::splat<Real> made{};
        made.x = static_cast<Real>(s.x);
        made.y = static_cast<Real>(s.y);
        made.opacity = static_cast<Real>(s.opacity);
        made.reach = static_cast<Real>(std::log2(static_cast<double>(made.opacity) * 255));
        made.p = shape.p;
        made.q = shape.q;
        made.r = shape.r;
        made.slope_x = shape.slope_x;
        made.slope_y = shape.slope_y;
        made.red = static_cast<Real>(s.colour[0]);
        made.green = static_cast<Real>(s.colour[1]);
        made.blue = static_cast<Real>(s.colour[2]);
        return made;
    }

    static gs::raster::splat<double> widen(const gs::raster::splat<Real>& s) {
        gs::raster::splat<double> d{};
        d.x = s.x;
        d.y = s.y;
        d.reach = s.reach;
        d.opacity = s.opacity;
        d.p = s.p;
        d.q = s.q;
        d.r = s.r;
        d.red = s.red;
        d.green = s.green;
        d.blue = s.blue;
        return d;
    }
};

}  // namespace hard_cases
