// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "held_out_views.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>

#include "../core/parallel.hpp"
#include "../scene/view_photo.hpp"
#include "fit_exposure.hpp"
#include "interior_ssim.hpp"
#include "png_psnr.hpp"

namespace gs::evaluate {

namespace {

/// A render and its photo, as three planes of values in [0, 1]. Masked pixels show the background
/// in both.
struct image_pair {
    std::vector<float> render, target;
};

image_pair comparable(const std::vector<float>& render, const image& photo,
                      const std::array<float, 3>& background) {
    image_pair pair{render, over_background(photo, background.data())};
    const std::size_t pixels = render.size() / 3;
    for (std::size_t i = 0; i < render.size(); ++i)
        pair.render[i] = photo.is_masked(i % pixels) ? pair.target[i] : std::clamp(render[i], 0.0F, 1.0F);
    return pair;
}

/// Measures and writes the views of a scene, as many at a time as there are threads.
class batch {
  public:
    batch(train::engine& engine, const scene& scene, const std::array<float, 3>& background,
          const held_out_options& options)
        : engine_(engine),
          scene_(scene),
          background_(background),
          options_(options),
          names_(render_names(scene.test)),
          renders_(static_cast<std::size_t>(omp_get_max_threads())),
          refined_(renders_.size()),
          pairs_(renders_.size()) {}

    std::size_t size() const { return renders_.size(); }

    /// Sets the measurements of `count` views, which begin with `first`, in those of all views.
    void measure(std::size_t first, std::size_t count, std::vector<view_values>& to) {
        for (std::size_t i = 0; i < count; ++i)
            to[first + i].quality = engine_.measure(first + i, background_, &renders_[i]);
        for (std::size_t i = 0; options_.refines_poses && i < count; ++i)
            refined_[i] =
                engine_.render(engine_.cameras().refined_camera(first + i, background_), background_);
        for_each_in_parallel(count, [&](std::size_t i) { measure_on_host(first, i, to[first + i]); });
        // Each image uses all threads, because the features of one image need much memory.
        if (options_.network)
            for (std::size_t i = 0; i < count; ++i) {
                const camera& c = scene_.test[first + i].camera;
                to[first + i].lpips =
                    options_.network->distance(pairs_[i].render, pairs_[i].target, c.width, c.height);
            }
    }

    /// Writes the images of the last call of `measure`. Each thread compresses one PNG at a time,
    /// because compression takes longer than rendering.
    void write(std::size_t first, std::size_t count) const {
        for_each_in_parallel(2 * count, [&](std::size_t job) {
            const std::size_t i = job / 2;
            const bool is_render = job % 2 == 0;
            const camera& c = scene_.test[first + i].camera;
            write_png(options_.folder / (is_render ? "renders" : "gt") / names_[first + i], c.width, c.height,
                      is_render ? renders_[i] : pairs_[i].target);
        });
    }

  private:
    void measure_on_host(std::size_t first, std::size_t i, view_values& to) {
        const view_photo decoded(scene_.test[first + i]);
        const image& photo = decoded.pixels();
        const image_pair& pair = pairs_[i] = comparable(renders_[i], photo, background_);
        to.ssim_interior = interior_ssim(pair.render, pair.target, photo);
        to.psnr_8bit = png_psnr(pair.render, pair.target, photo);
        if (options_.fits_exposure) to.fitted_psnr = psnr_after_fit(renders_[i], photo, background_);
        if (options_.refines_poses)
            to.refined_psnr = options_.fits_exposure ? psnr_after_fit(refined_[i], photo, background_)
                                                     : psnr_of_right_half(refined_[i], photo, background_);
    }

    train::engine& engine_;
    const scene& scene_;
    const std::array<float, 3>& background_;
    const held_out_options& options_;
    std::vector<std::string> names_;
    std::vector<std::vector<float>> renders_, refined_;  ///< not clamped
    std::vector<image_pair> pairs_;
};

/// Gives all ranks the measurements of the others.
void gather(ranks::communicator& all, const ranks::shares& shares, std::vector<view_values>& values) {
    static_assert(std::is_trivially_copyable_v<view_values>);
    const ranks::traffic_counter::scope scope(all.traffic(), ranks::purpose::other);
    const auto array = ranks::shared_array::of(values.data(), 1, values.size());
    all.gather(shares, {&array, 1});
}

}  // namespace

std::vector<std::string> render_names(const std::vector<view>& views) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const view& v : views) {
        std::string flat = v.name;
        std::ranges::replace(flat, '/', '_');
        std::string name = std::filesystem::path(flat).replace_extension(".png").string();
        for (int again = 2; !taken.insert(name).second; ++again)
            name = flat + "_" + std::to_string(again) + ".png";
        names.push_back(name);
    }
    return names;
}

double held_out_report::psnr() const { return mean_of("psnr").value_or(std::nan("")); }
double held_out_report::ssim() const { return mean_of("ssim").value_or(std::nan("")); }
std::optional<double> held_out_report::mean_of(std::string_view key) const {
    const auto found = std::ranges::find(view_measures, key, &view_measure::key);
    return mean(views, *found);
}

held_out_report measure_held_out_views(train::engine& engine, const scene& scene,
                                       const std::array<float, 3>& background,
                                       const held_out_options& options) {
    held_out_report report;
    if (options.network) report.lpips_black = options.network->black();
    const bool writes = !options.folder.empty();
    ranks::communicator alone;
    ranks::communicator& all = options.ranks != nullptr ? *options.ranks : alone;
    if (writes && all.is_first()) {
        std::filesystem::create_directories(options.folder / "renders");
        std::filesystem::create_directories(options.folder / "gt");
    }
    if (writes) all.barrier();
    engine.ranks().prepare_renders();
    // Consecutive views, so that each rank loads streamed photos ahead for itself only.
    const ranks::shares shares(scene.test.size(), 1, all.count());
    const ranks::share own = shares.of(all.rank());
    std::vector<view_values> values(scene.test.size());
    batch views(engine, scene, background, options);
    for (std::size_t first = own.first; first < own.last; first += views.size()) {
        const std::size_t count = std::min(views.size(), own.last - first);
        views.measure(first, count, values);
        if (writes) views.write(first, count);
    }
    gather(all, shares, values);
    for (std::size_t v = 0; v < values.size(); ++v) report.views.push_back({values[v], scene.test[v].name});
    return report;
}

}  // namespace gs::evaluate
