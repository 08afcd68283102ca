// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../core/error.hpp"
#include "../live/scene_overview.hpp"
#include "../writers/writer.hpp"
#include "command_context.hpp"
#include "commands.hpp"
#include "live_training.hpp"
#include "stop_signals.hpp"

namespace gs::cli {

void view_model(const settings& s) {
    const command_context context(s);
    gaussians model = read_model(s.ply);
    context.require_no_background_before(model);
    if (model.count() == 0) throw error(s.ply + " holds no Gaussians: there is nothing to draw");
    model = to_internal(normalization_of(model), std::move(model));
    const auto engine = context.make_engine();
    engine->set_model(model);
    const std::vector<gs::view> no_views;
    live::frame_artist artist(*engine, no_views, context.background(false).color);
    const stop_signals signals;
    live::live_view page(viewer_address(s), live::scene_json(orbit_of(model), no_views), 0,
                         {.draw = [&](const live::view_request& request) { return artist.draw(request); }});
    page.set_status({.gaussians = model.count()});
    print_viewer_url(page, s);
    context.say("Ctrl-C ends the live view");
    while (signals.received() == 0 && !page.is_stopped()) page.attend_for(std::chrono::milliseconds(200));
}

}  // namespace gs::cli
