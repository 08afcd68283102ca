// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "backend.hpp"
#include "lab/accumulator_set.hpp"
#include "losses/l1_ssim/l1_ssim.hpp"
#include "memory_on.hpp"
#include "render/renderer.hpp"

namespace hard_cases {

/// The gradient by the image, pixel by pixel more or less of it.
template <class Real>
struct weigh_pixels {
    const Real* gradient;
    const Real* weights;
    std::size_t pixels;
    Real* weighed;

    WARPAGG_HD void operator()(std::size_t i) const { weighed[i] = gradient[i] * weights[i % pixels]; }
};

/// The operations of a backend on Gaussians.
template <class Device, class Real>
class renders_on {
    template <class T>
    using buffer = typename Device::template buffer<T>;
    using memory = memory_on<Device, Real>;
    using parameters = std::array<buffer<Real>, gs::parameter_count>;

    using renderer = gs::raster::renderer<Device, Real, gs::raster::cut_for<typename Device::warp>,
                                          gs::lab::lab_accumulators>;

    struct session {
        Device device;
        memory on{device};
        renders_on::renderer renderer{device};
        gs::train::l1_ssim<Device, Real> loss{device};
        parameters values, gradients;
        buffer<std::uint8_t> photo;
        buffer<Real> background_image, by_depths;
        double depth_loss = 0;

        void draw(const render_case& q) {
            for (std::size_t p = 0; p < gs::parameter_count; ++p) {
                put(on, values[p], q, p);
                gradients[p].resize(values[p].size());
            }
            const auto model = read(values);
            const gs::camera& camera = q.view.camera;
            // Room to spare, as in training: places that stay empty are part of the lists.
            renderer.set_effects(q.effects);
            renderer.measure(model, q.count(), camera, q.sh_degree);
            const std::uint64_t required = renderer.instances();
            renderer.reserve_instances(required, required / 2 + 64);
            if (!q.background_image.empty()) on.put(background_image, q.background_image);
            renderer.list(model, q.count(), camera, q.sh_degree);
            if (!q.depth_weights.empty()) draw_depths(q);
            renderer.blend(q.background, q.background_image.empty() ? nullptr : background_image.data());
            on.put_bytes(photo, q.view.pixels.rgba);
            loss.set_target({photo.data(), camera.width, camera.height, q.background});
        }

        void draw_depths(const render_case& q) {
            renderer.blend_depths();
            const std::vector<double> inverse = on.get(renderer.render(), q.pixels());
            std::vector<double> weights = q.depth_weights;
            for (std::size_t i = 0; i < q.pixels(); ++i) {
                if (!q.weights.empty()) weights[i] *= q.weights[i];
                depth_loss += weights[i] * inverse[i];
            }
            weights.resize(3 * q.pixels());
            on.put(by_depths, weights);
            renderer.backward_depths(by_depths.data(), largest_gradient(q), q.how);
        }
    };

    /// The gradient of a pixel with respect to image and inverse depth.
    static float largest_gradient(const render_case& q) {
        return (q.weights.empty() ? 1 : largest_of(q.weights)) / static_cast<float>(q.pixels());
    }

  public:
    static render_result render(const render_case& q) {
        session s;
        s.draw(q);
        const std::size_t values = 3 * q.pixels();
        buffer<Real> given;
        if (!q.gradient_at.empty()) s.on.put(given, q.gradient_at);
        const Real* by_render =
            s.loss.gradient(q.gradient_at.empty() ? s.renderer.render() : given.data(), {});
        buffer<Real> weights, weighed;
        if (!q.weights.empty()) {
            s.on.put(weights, q.weights);
            weighed.resize(values);
            s.device.for_each_index(
                values, weigh_pixels<Real>{by_render, weights.data(), q.pixels(), weighed.data()});
            by_render = weighed.data();
        }
        buffer<gs::raster::visibility> seen;
        seen.resize(q.count());
        s.device.zero(seen.data(), q.count());
        s.renderer.backward(by_render, largest_gradient(q), q.how, q.sh_degree,
                            gs::raster::store_gradients<Real>{write(s.gradients)}, seen.data());

        render_result a;
        a.render = s.on.get(s.renderer.render(), values);
        a.loss = s.loss.take().loss + s.depth_loss;
        for (std::size_t p = 0; p < gs::parameter_count; ++p)
            a.gradients[p] = get(s.on, s.gradients[p], q, p);
        const auto sightings = s.on.get_as_they_are(seen.data(), q.count());
        a.sightings.resize(sightings.size());
        std::ranges::transform(sightings, a.sightings.begin(), [](const gs::raster::visibility& v) {
            return sighting{static_cast<double>(v.gradient), static_cast<double>(v.seen)};
        });
        return a;
    }

    static double loss(const render_case& q) {
        session s;
        s.draw(q);
        s.loss.gradient(s.renderer.render(), {});
        return s.loss.take().loss + s.depth_loss;
    }

    static std::vector<projected_splat> project(const render_case& q) {
        Device device;
        memory on(device);
        parameters values;
        for (std::size_t p = 0; p < gs::parameter_count; ++p) put(on, values[p], q, p);
        buffer<gs::raster::splat<Real>> splats;
        buffer<gs::raster::tile_box> boxes;
        buffer<std::uint32_t> depths, identities, tiles;
        const std::size_t n = q.count();
        splats.resize(n);
        boxes.resize(n);
        identities.resize(n);
        // Leftovers of an earlier frame.
        on.put_as_they_are(depths, std::vector<std::uint32_t>(n, 0));
        on.put_as_they_are(tiles, std::vector<std::uint32_t>(n, 1));
        const auto tiles_along = [](int pixels) {
            return static_cast<unsigned>((pixels + gs::raster::tile_size - 1) / gs::raster::tile_size);
        };
        const gs::camera& camera = q.view.camera;
        gs::effect_set effects = q.effects;
        effects.lens = camera.lens();
        effects.motion = camera.motion.has_value();
        using narrow = typename Device::narrow_warp;
        gs::raster::with_effects(effects, [&]<gs::effect_set Effects> {
            using projection = gs::raster::project<narrow, Real, Effects>;
            device.template for_each_warp<narrow>(
                projection::warps(n),
                projection{read(values), n,
                           gs::raster::camera_for<warpagg::value_t<narrow, Real>, Effects>(camera),
                           q.sh_degree, tiles_along(camera.width), tiles_along(camera.height), splats.data(),
                           boxes.data(), depths.data(), identities.data(), tiles.data()});
        });
        const auto host = on.get_as_they_are(splats.data(), n);
        const auto depth = on.get_as_they_are(depths.data(), n), met = on.get_as_they_are(tiles.data(), n);
        std::vector<projected_splat> found(n);
        for (std::size_t i = 0; i < n; ++i) {
            const gs::raster::splat<double> s = widen(host[i]);
            found[i] = {met[i] > 0, depth[i], s.x, s.y,   s.cutoff, std::exp2(s.log2_opacity),
                        s.p,        s.q,      s.r, s.red, s.green,  s.blue};
        }
        return found;
    }

    static std::string complaint_about_instances(std::uint64_t instances) {
        Device device;
        renders_on::renderer renderer(device);
        try {
            renderer.reserve_instances(instances);
        } catch (const gs::error& e) {
            return e.what();
        }
        return "";
    }

  private:
    /// One parameter of all Gaussians, or its gradients; none where the case has none.
    static void put(memory& on, buffer<Real>& to, const render_case& q, std::size_t p) {
        const std::size_t width = gs::width_of(static_cast<gs::parameter>(p));
        on.put(to, gs::to_blocks(q.parameters[p].data(), q.parameters[p].size() / width, width, width));
    }
    static std::vector<double> get(memory& on, const buffer<Real>& from, const render_case& q,
                                   std::size_t p) {
        const std::size_t width = gs::width_of(static_cast<gs::parameter>(p));
        std::vector<double> rows(q.parameters[p].size());
        const std::vector<double> blocks = on.get(from.data(), from.size());
        gs::from_blocks(blocks.data(), rows.size() / width, width, width, rows.data());
        return rows;
    }

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

    static gs::raster::splat<double> widen(const gs::raster::splat<Real>& s) {
        gs::raster::splat<double> d{};
        d.x = s.x;
        d.y = s.y;
        d.cutoff = s.cutoff;
        d.log2_opacity = s.log2_opacity;
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
