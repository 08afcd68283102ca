// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <httplib.h>
#include <omp.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <stdexcept>
#include <thread>

#include "../live/serve.hpp"
#include "../training/check_equal.hpp"
#include "cli/live_training.hpp"
#include "readers/load_scene.hpp"
#include "run_program.hpp"
#include "training/initialize.hpp"

namespace {

using namespace gs_test;

gs::scene spheres() {
    gs::scene scene = gs::load_scene({.data = "synthetic:spheres", .resolution = 32}, [](const auto&) {});
    gs::normalize(scene, [](const auto&) {});
    return scene;
}

/// Trains with growth. If it is watched, a page asks for frames, pauses, saves and resumes.
gs::gaussians trained(const gs::scene& scene, bool is_watched) {
    const auto engine = gs::train::make_cpu_engine();
    gs::train::train_options options;
    options.schedule.iterations = 120;
    options.max_cap = 3000;
    options.gradient = gs::accumulator::fixed;
    auto& adaptive = options.densification.of<gs::train::adaptive_config>();
    adaptive.densify_from_iter = 20;
    adaptive.densification_interval = 20;
    adaptive.densify_until_iter = 100;
    adaptive.densify_grad_threshold = 1e-5;
    engine->set_views(scene.train, {}, options.schedule.num_downscales);
    engine->set_model(gs::from_points(scene.points, 1, 500, 1));
    gs::train::train_events events;
    events.report = [](const auto&) {};
    std::optional<gs::cli::live_training> live;
    std::thread pages;
    if (!is_watched) return gs::train::train(*engine, scene, options, events), engine->get_model();

    gs::cli::settings settings;
    settings.viewer = fake_server::any_port();
    int saves = 0;
    live.emplace(settings, *engine, scene, options,
                 gs::cli::live_training::callbacks{[&](int) { return std::to_string(++saves); },
                                                   [] { return false; }});
    std::atomic<int> frames = 0;
    events.schedule = [&](gs::train::training& t) {
        live->add_to(t);
        // On a busy machine, training could end before the page pauses it.
        t.add({gs::train::phase::observe, "wait for the page", [&](int) { return frames < 5; },
               [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(50)); }});
    };
    events.report = [&](const gs::train::progress& p) { live->report(p); };
    std::atomic<bool> has_ended = false;
    pages = std::thread([&] {
        httplib::Client client("127.0.0.1", *settings.viewer);
        const std::string token = live->view().token();
        const httplib::Headers headers{{"X-Token", token},
                                       {"Origin", "http://127.0.0.1:" + std::to_string(*settings.viewer)}};
        const std::string free = "&overlay=depth&position=0,0,-2&forward=0,0,1&up=0,-1,0&field_of_view=2";
        for (int i = 0; !has_ended; ++i) {
            // Larger than the photos, from inside of the scene: its tile lists are longer than theirs.
            const std::string view = i % 2 == 0 ? free : "&overlay=error&view=" + std::to_string(i % 7);
            const auto r = client.Get("/frame?page=a&width=200&height=150" + view, headers);
            frames += r && r->status == 200;
            if (i == 3) client.Post("/pause", headers, "", "text/plain");
            if (i == 5) client.Post("/save", headers, "", "text/plain");
            if (i == 9) client.Post("/resume", headers, "", "text/plain");
        }
    });
    gs::train::train(*engine, scene, options, events);
    has_ended = true;
    live.reset();
    pages.join();
    CHECK(frames > 9);
    CHECK(saves == 1);
    return engine->get_model();
}

/// The URL and the token that a run has printed.
struct printed_url {
    int port = 0;
    std::string token{};
};

printed_url await_url(const fs::path& output) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < until) {
        std::ifstream in(output);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        std::smatch found;
        if (std::regex_search(text, found, std::regex("http://127.0.0.1:([0-9]+)/\\?token=([0-9a-f]{32})\n")))
            return {std::stoi(found[1]), found[2]};
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("the program has printed no URL");
}

void press(const printed_url& url, const std::string& button) {
    httplib::Client client("127.0.0.1", url.port);
    const std::string origin = "http://127.0.0.1:" + std::to_string(url.port);
    const auto r = client.Post("/" + button, {{"X-Token", url.token}, {"Origin", origin}}, "", "text/plain");
    CHECK(r->status == 200);
}

}  // namespace

TEST_CASE("viewer: a training that is watched, paused and saved has the bits of one that is not") {
    const gs::scene scene = spheres();
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);  // the threads of the server would compete with several
    check_equal(trained(scene, true), trained(scene, false));
    omp_set_num_threads(threads);
}

TEST_CASE("viewer: stop saves the model and a checkpoint, with which the training continues") {
    const temporary_folder folder;
    const fs::path output = folder / "run";
    const words command{"train", "-d", "synthetic:spheres", "-r", "32", "--effects", "none", "--device",
                        "cpu",   "-o", output.string()};
    const outcome stopped =
        run_and_then(command + words{"-i", "100000", "--viewer", std::to_string(fake_server::any_port())},
                     [](pid_t, const fs::path& out) { press(await_url(out), "stop"); });
    CHECK(stopped.code == 128 + SIGINT);
    CHECK(stopped.err.find("--resume") != std::string::npos);
    CHECK(fs::exists(output / "checkpoints"));
    int models = 0;
    for (const auto& entry : fs::directory_iterator(output / "point_cloud"))
        models += fs::exists(entry.path() / "point_cloud.ply");
    CHECK(models == 1);
}

TEST_CASE("viewer: stop without a checkpoint is an error") {
    const temporary_folder folder;
    const fs::path output = folder / "run";
    const outcome stopped = run_and_then(
        {"train", "-d", "synthetic:spheres", "-r", "32", "--effects", "none", "--device", "cpu", "-o",
         output.string(), "-i", "100000", "--viewer", std::to_string(fake_server::any_port())},
        [&](pid_t, const fs::path& out) {
            const printed_url url = await_url(out);
            write_file(output / "checkpoints", "a file in the place of the folder");
            press(url, "stop");
        });
    CHECK(stopped.code == 2);
    CHECK(says(stopped.err, {"checkpoints"}));
    CHECK(stopped.err.find("training continues") == std::string::npos);
}

TEST_CASE("viewer: view shows a model until it is stopped or interrupted") {
    const temporary_folder folder;
    const fs::path output = folder / "run";
    check_success({"train", "-d", "synthetic:spheres", "-r", "32", "-i", "5", "--effects", "none", "--device",
                   "cpu", "-o", output.string(), "-q"});
    const words command{"view", model_of(output, 5).string(), "--device", "cpu", "-q"};
    const outcome stopped = run_and_then(command, [](pid_t, const fs::path& out) {
        const printed_url url = await_url(out);
        httplib::Client client("127.0.0.1", url.port);
        CHECK(client.Get(frame_path, {{"X-Token", url.token}})->status == 200);
        press(url, "stop");
    });
    CHECK(stopped.code == 0);
    const outcome interrupted = run_and_then(command, [](pid_t process, const fs::path& out) {
        await_url(out);
        kill(process, SIGINT);
    });
    CHECK(interrupted.code == 0);
}

TEST_CASE("viewer: a port in use is one sentence, before anything is written") {
    const fake_server other;
    const std::string port = std::to_string(other.server.port());
    check_refusal_without_trace(
        {"train", "-d", "synthetic:spheres", "-r", "32", "-i", "5", "--device", "cpu", "--viewer", port},
        {"port " + port, "leave out the port"});
}
