// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "../core/byte_size.hpp"
#include "../core/error.hpp"
#include "../edit/edit.hpp"
#include "../writers/spz/spz.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "commands.hpp"

namespace gs::cli {
namespace {

std::vector<camera> training_cameras(const settings& s, const command_context& context) {
    std::vector<camera> cameras;
    if (s.scene.data.empty()) return cameras;
    const scene scene = load_scene(s.scene, [&](const std::string& line) { context.say(line); });
    for (const view& v : scene.train) cameras.push_back(v.camera);
    return cameras;
}

glm::dvec3 direction_of(up_axis up) {
    const int index = static_cast<int>(up);
    glm::dvec3 direction(0);
    direction[index / 2] = index % 2 == 0 ? 1 : -1;
    return direction;
}

/// Applies the filters in this order: those that judge a Gaussian by itself come before the one that
/// counts them.
gaussians edited(gaussians model, const settings& s, const command_context& context) {
    const auto report = [&](const char* filter, gaussians result) {
        context.say(std::string(filter) + " keeps " + std::to_string(result.count()) + " of " +
                    std::to_string(model.count()) + " Gaussians");
        model = std::move(result);
    };
    if (s.crop) report("--crop", edit::crop(model, *s.crop));
    if (s.remove_floaters)
        report("--remove-floaters", edit::remove_floaters(model, training_cameras(s, context)));
    if (s.decimate) report("--decimate", edit::decimate(model, s.decimate->of(model.count())));
    const bool becomes_gaussians =
        s.sky == sky_form::gaussians || (s.sky == sky_form::automatic && !holds_sky(s.output));
    if (s.sky == sky_form::none) model.sky.clear();
    if (becomes_gaussians && !model.sky.empty()) {
        context.say("the learned background becomes " + std::to_string(edit::sky_count) + " Gaussians");
        model = edit::with_sky_gaussians(std::move(model));
    }
    if (s.up) model = edit::rotate(model, edit::upright(direction_of(*s.up)));
    return model;
}

void require_spz_for_its_options(const settings& s) {
    if (s.given.contains("spz_version") && !has_ending(s.output, spz_writer))
        throw error("--spz-version is for .spz files, but OUT is " + s.output +
                    ": leave it out, or give OUT the ending .spz");
}

}  // namespace

void convert(const settings& s) {
    const command_context context(s);
    std::error_code ignored;
    if (std::filesystem::equivalent(s.ply, s.output, ignored))
        throw error("convert would replace its own input " + s.ply + ": give OUT another name");
    require_known_ending(s.output);
    require_spz_for_its_options(s);
    // The first use of a GPU takes long, so it happens while this thread reads, and only if colors will
    // be clustered.
    const bool clusters = clusters_colors(s.output) && s.export_options.max_sh_degree > 0;
    auto uses_cuda = std::async(std::launch::async, [&] { return clusters && context.can_use_cuda(); });
    gaussians model = read_model(s.ply);
    write_options options = s.export_options;
    if (uses_cuda.get()) options.k_means = cluster::k_means_on_cuda;  // refuses an unusable device
    model = edited(std::move(model), s, context);
    write_model(s.output, model, options);
    for (const std::string& part : left_out(s.output, model, options)) context.warn(part);
    context.say(s.output + ": " + std::to_string(model.count()) + " Gaussians, " +
                size_in_bytes(std::filesystem::file_size(s.output)));
}

}  // namespace gs::cli
