// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "../live/draw_frame.hpp"
#include "../live/live_view.hpp"
#include "../training/training.hpp"
#include "settings.hpp"

namespace gs::cli {

/// Returns where the server of --viewer or --port listens.
live::server_address viewer_address(const settings& s);

/// Prints the URL of the page at any log level, and warns if other machines can reach it.
void print_viewer_url(const live::live_view& view, const settings& s);

/// The live view of --viewer while training runs.
class live_training {
  public:
    struct callbacks {
        std::function<std::string(int iteration)> save;  ///< returns the name of the file
        std::function<bool()> is_interrupted;
    };

    /// Starts the server. All arguments must outlive the object.
    live_training(const settings& s, train::engine& engine, const scene& scene,
                  const train::train_options& options, callbacks of_run);

    /// Adds the action that draws frames between iterations.
    void add_to(train::training& training);
    void report(const train::progress& progress);
    /// Returns whether a page asked to stop.
    bool is_stopped() const { return view_.is_stopped(); }
    const live::live_view& view() const { return view_; }

  private:
    callbacks callbacks_;
    live::frame_artist artist_;
    int iteration_ = 0;
    live::live_view view_;
};

}  // namespace gs::cli
