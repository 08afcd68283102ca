// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>

#include "http_server.hpp"
#include "mailbox.hpp"

namespace gs::live {

/// What the page tells about the model and the training.
struct live_status {
    bool trains = false;  ///< otherwise, there is only a model to look at
    int iteration = 0, iterations = 0;
    double loss = 0, psnr = 0;  ///< means since the report before
    std::size_t gaussians = 0;
    double seconds_left = 0;
    std::string note{};  ///< the last event, such as a saved file, or empty
};

/// A page that shows the model of an engine, and the thread of this engine. Pages get frames only
/// when this thread calls `attend`, so that no other thread touches the engine.
class live_view {
    using clock = std::chrono::steady_clock;

  public:
    /// Draws frames, and saves the model. Both run in the thread that calls `attend`.
    struct actions {
        std::function<picture(const view_request&)> draw;
        std::function<std::string()> save = {};  ///< returns a note for the page
        std::function<bool()> is_interrupted = [] { return false; };
    };

    /// Starts the server: see `http_server`. `scene`: see `scene_json`.
    live_view(const server_address& address, std::string scene, std::size_t views, actions of_engine);
    live_view(const live_view&) = delete;
    live_view& operator=(const live_view&) = delete;
    ~live_view();

    std::string url() const { return server_.url(); }
    std::string token() const { return server_.token(); }
    int port() const { return server_.port(); }

    void set_status(const live_status& status);
    void set_iteration(int iteration) { iteration_.store(iteration, std::memory_order_relaxed); }
    std::string status_json();

    /// Returns whether `attend` has something to do. Cheap if no page waits. Frames take at most half
    /// of the time: after a frame, returns false for as long as the frame took.
    bool needs_attention() const {
        return has_orders_.load(std::memory_order_relaxed) ||
               (mailbox_.requests() > 0 && clock::now() >= next_frame_);
    }
    /// Draws the frames that pages wait for, and saves if a page asks for it. While a page pauses
    /// the training, does not return.
    void attend();
    /// Attends to pages for at most this time, or until there is something to do.
    void attend_for(std::chrono::milliseconds patience);
    /// Returns whether a page asked to stop.
    bool is_stopped() const { return is_stopped_; }

  private:
    void press(button b);
    void save_if_asked();
    void draw_frames();

    actions actions_;
    std::string scene_;
    mailbox mailbox_;
    std::mutex lock_;
    live_status status_;
    std::atomic<int> iteration_ = 0;
    std::atomic<bool> trains_ = false, has_orders_ = false, is_paused_ = false, saves_ = false,
                      is_stopped_ = false;
    clock::time_point next_frame_{};
    http_server server_;  ///< last: its threads use the other members
};

}  // namespace gs::live
