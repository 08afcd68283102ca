// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <httplib.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "live/live_view.hpp"
#include "serve.hpp"

using gs::live::live_view;
using nlohmann::json;

namespace {

/// A live view, the thread that attends to it, and a page.
struct attended_view {
    std::atomic<int> frames = 0, saves = 0, iterations = 0;
    std::atomic<bool> fails = false, is_interrupted = false;
    live_view view{{.port = gs_test::fake_server::any_port()},
                   R"({"views":[]})",
                   1,
                   {.draw =
                        [this](const auto&) {
                            ++frames;
                            return gs::live::picture{1, 1, {1, 2, 3}};
                        },
                    .save = [this] { return save(); },
                    .is_interrupted = [this] { return is_interrupted.load(); }}};
    std::thread loop;

    attended_view() { view.set_status({.trains = true, .iterations = 1000}); }
    ~attended_view() {
        is_interrupted = true;
        if (loop.joinable()) loop.join();
    }
    void run() {
        loop = std::thread([this] {
            while (!is_interrupted && !view.is_stopped()) {
                view.set_iteration(++iterations);
                if (view.needs_attention()) view.attend();
            }
        });
    }
    std::string save() {
        ++saves;
        if (fails) throw std::runtime_error("the disk is full");
        return "saved it";
    }

    httplib::Client client() const { return httplib::Client("127.0.0.1", view.port()); }
    json press(const std::string& name) const {
        const std::string origin = "http://127.0.0.1:" + std::to_string(view.port());
        return json::parse(
            client()
                .Post("/" + name, {{"X-Token", view.token()}, {"Origin", origin}}, "", "text/plain")
                ->body);
    }
    json status() const { return json::parse(client().Get("/status", {{"X-Token", view.token()}})->body); }
    int frame() const { return client().Get(gs_test::frame_path, {{"X-Token", view.token()}})->status; }
    void await(const std::function<bool()>& condition) const {
        while (!condition()) std::this_thread::yield();
    }
};

}  // namespace

TEST_CASE("live view: frames are drawn between iterations") {
    attended_view v;
    v.run();
    CHECK(v.frame() == 200);
    CHECK(v.frames == 1);
    CHECK(v.status().at("state") == "training");
}

TEST_CASE("live view: a paused training draws and saves, and continues when it is told to") {
    attended_view v;
    v.run();
    CHECK(v.press("pause").at("state") == "paused");
    v.frame();  // the loop has reached the pause, and draws
    const int iteration = v.iterations;
    CHECK(v.frame() == 200);
    v.press("save");
    v.await([&] { return v.saves == 1; });
    CHECK(v.iterations == iteration);
    v.await([&] { return v.status().at("note") == "saved it"; });
    CHECK(v.press("resume").at("state") == "training");
    v.await([&] { return v.iterations > iteration; });
}

TEST_CASE("live view: a failed save is told to the page, and training continues") {
    attended_view v;
    v.fails = true;
    v.run();
    v.press("save");
    v.await([&] { return v.status().at("note") == "the disk is full"; });
    const int iteration = v.iterations;
    v.await([&] { return v.iterations > iteration; });
}

TEST_CASE("live view: stop and an interruption end a pause") {
    for (const bool stops : {true, false}) {
        attended_view v;
        v.run();
        v.press("pause");
        v.frame();
        if (stops)
            CHECK(v.press("stop").at("state") == "stopping");
        else
            v.is_interrupted = true;
        v.loop.join();
        CHECK(v.view.is_stopped() == stops);
    }
}

TEST_CASE("live view: the buttons of a training do nothing for a model") {
    attended_view v;
    v.view.set_status({.trains = false});
    v.run();
    v.press("pause");
    v.press("save");
    CHECK(v.frame() == 200);
    CHECK(v.status().at("state") == "viewing");
    CHECK(v.saves == 0);
    const int iteration = v.iterations;
    v.await([&] { return v.iterations > iteration; });
}

TEST_CASE("live view: frames take at most half of the time") {
    using namespace std::chrono;
    live_view view({.port = gs_test::fake_server::any_port()}, "{}", 0, {.draw = [](const auto&) {
                       std::this_thread::sleep_for(milliseconds(50));
                       return gs::live::picture{1, 1, {1, 2, 3}};
                   }});
    std::atomic<bool> ends = false, has_ended = false;
    std::thread page([&] {
        httplib::Client c("127.0.0.1", view.port());
        while (!ends) c.Get(gs_test::frame_path, {{"X-Token", view.token()}});
        has_ended = true;
    });
    for (int frame = 0; frame < 3; ++frame) {
        while (!view.needs_attention()) std::this_thread::yield();
        view.attend();
        const auto end = steady_clock::now();
        while (!view.needs_attention()) std::this_thread::yield();
        CHECK(steady_clock::now() - end >= milliseconds(50));
    }
    ends = true;
    while (!has_ended) view.attend_for(milliseconds(10));
    page.join();
}
