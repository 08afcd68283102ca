// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "live_view.hpp"

#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

namespace gs::live {
namespace {

/// How long a page waits for a frame. An iteration of a large scene on a CPU takes seconds.
constexpr std::chrono::seconds patience_of_page{20};

}  // namespace

live_view::live_view(const server_address& address, std::string scene, std::size_t views, actions of_engine)
    : actions_(std::move(of_engine)),
      scene_(std::move(scene)),
      server_(address, {.scene = [this] { return scene_; },
                        .status = [this] { return status_json(); },
                        .views = views,
                        .draw =
                            [this](const std::string& page, const view_request& request) {
                                return mailbox_.ask(page, request, patience_of_page);
                            },
                        .press = [this](button b) { press(b); }}) {}

live_view::~live_view() { mailbox_.close(); }

void live_view::set_status(const live_status& status) {
    const std::lock_guard held(lock_);
    const std::string note = status.note.empty() ? status_.note : status.note;
    status_ = status;
    status_.note = note;
    trains_ = status.trains;
    iteration_ = status.iteration;
}

std::string live_view::status_json() {
    const std::lock_guard held(lock_);
    const char* state = !status_.trains ? "viewing"
                        : is_stopped_   ? "stopping"
                        : is_paused_    ? "paused"
                                        : "training";
    return nlohmann::ordered_json({{"state", state},
                                   {"iteration", iteration_.load()},
                                   {"iterations", status_.iterations},
                                   {"loss", status_.loss},
                                   {"psnr", status_.psnr},
                                   {"gaussians", status_.gaussians},
                                   {"seconds_left", status_.seconds_left},
                                   {"note", status_.note}})
        .dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}

/// Runs in threads of the server.
void live_view::press(button b) {
    if (!trains_ && b != button::stop) return;
    switch (b) {
        case button::pause:
            is_paused_ = true;
            break;
        case button::resume:
            is_paused_ = false;
            break;
        case button::save:
            saves_ = true;
            break;
        case button::stop:
            is_stopped_ = true;
            break;
    }
    has_orders_ = true;
    mailbox_.ring();
}

void live_view::save_if_asked() {
    if (!saves_.exchange(false) || !actions_.save) return;
    std::string note;
    try {
        note = actions_.save();
    } catch (const std::exception& failed) {
        note = failed.what();
    }
    const std::lock_guard held(lock_);
    status_.note = note;
}

void live_view::draw_frames() {
    const auto from = clock::now();
    mailbox_.serve(actions_.draw);
    const auto to = clock::now();
    next_frame_ = to + (to - from);
}

void live_view::attend() {
    constexpr std::chrono::milliseconds patience{100};  // until `is_interrupted` is asked again
    has_orders_ = false;
    do {
        save_if_asked();
        draw_frames();
        if (is_paused_) mailbox_.wait(patience);
    } while (is_paused_ && !is_stopped_ && !actions_.is_interrupted());
}

void live_view::attend_for(std::chrono::milliseconds patience) {
    mailbox_.wait(patience);
    attend();
}

}  // namespace gs::live
