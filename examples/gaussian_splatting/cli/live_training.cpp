// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "live_training.hpp"

#include <cstdio>
#include <utility>

#include "../live/access.hpp"
#include "../live/scene_overview.hpp"
#include "highlighted.hpp"

namespace gs::cli {

live::server_address viewer_address(const settings& s) {
    live::server_address address{.host = s.viewer_host};
    if (s.viewer.value_or(0) != 0) address.port = *s.viewer;
    return address;
}

void print_viewer_url(const live::live_view& view, const settings& s) {
    std::printf("live view %s\n", view.url().c_str());
    if (!live::is_loopback(s.viewer_host))
        std::printf("%s other machines can reach the live view, and its connections are not encrypted\n",
                    highlighted("warning:", message_color::yellow, stdout).c_str());
    std::fflush(stdout);
}

live_training::live_training(const settings& s, train::engine& engine, const scene& scene,
                             const train::train_options& options, callbacks of_run)
    : callbacks_(std::move(of_run)),
      artist_(engine, scene.train, options.background.color,
              [&] { return options.features.show_on_host(engine, scene); }),
      view_(viewer_address(s), live::scene_json(orbit_of(scene), scene.train), scene.train.size(),
            {.draw = [this](const live::view_request& request) { return artist_.draw(request); },
             .save = [this] { return "saved " + callbacks_.save(iteration_); },
             .is_interrupted = callbacks_.is_interrupted}) {
    view_.set_status(
        {.trains = true, .iterations = options.schedule.iterations.last(), .gaussians = engine.count()});
    print_viewer_url(view_, s);
}

void live_training::add_to(train::training& training) {
    training.add({train::phase::observe, "live view",
                  [this](int iteration) {
                      view_.set_iteration(iteration);
                      return view_.needs_attention();
                  },
                  [this, &training](int iteration) {
                      iteration_ = iteration;
                      training.call_untimed([this] { view_.attend(); });
                  }});
}

void live_training::report(const train::progress& p) {
    view_.set_status({.trains = true,
                      .iteration = p.iteration,
                      .iterations = p.iterations,
                      .loss = p.loss,
                      .psnr = p.psnr,
                      .gaussians = p.gaussians,
                      .seconds_left = (p.iterations - p.iteration) * p.seconds / p.iteration});
}

}  // namespace gs::cli
