// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "view_options.hpp"

#include <string>

#include "../live/http_server.hpp"

namespace gs::cli {
namespace {

using namespace options;
using enum command;

}  // namespace

std::vector<option> view_options(settings& s) {
    constexpr int most_port = 65535;
    const std::string group = "Output";
    option viewer{.names = "--viewer",
                  .group = group,
                  .commands = {train},
                  .value = whole(s.viewer, 0, most_port),
                  .help = "Shows the training in a browser, at a URL that it prints",
                  .default_text = "none",
                  .is_recorded = false};
    viewer.value.type = "[PORT]";
    viewer.value.range.clear();
    viewer.value.implied = "0";
    option port{.names = "--port",
                .group = group,
                .commands = {view},
                .value = whole(s.viewer, 0, most_port),
                .help = "Port of the page",
                .default_text =
                    std::to_string(live::server_address::default_port) + ", or a free port if it is in use"};
    option host{.names = "--viewer-host",
                .group = group,
                .commands = {view},
                .value = text(s.viewer_host, "ADDRESS"),
                .help = "Address that serves the page; 0.0.0.0 lets other machines reach it"};
    option host_of_training = host;
    host_of_training.commands = {train};
    host_of_training.needs = {"--viewer"};
    host_of_training.is_rare = true;
    host_of_training.is_recorded = false;
    return {viewer, port, host_of_training, host};
}

std::vector<option> video_options(settings& s) {
    std::vector<option> rows{
        {.names = "--orbit",
         .commands = {render},
         .value = flag(s.orbit),
         .help = "Draws a circle around the scene that keeps the typical distance and height of its "
                 "cameras; without --data, render always draws a circle",
         .excludes = {"--path"}},
        {.names = "--path",
         .commands = {render},
         .value = text(s.camera_path, "FILE"),
         .help = "JSON file with cameras that the path passes through, such as nerfstudio's "
                 "camera_path.json",
         .default_text = "none"},
        {.names = "--seconds",
         .commands = {render},
         .value = positive(s.seconds),
         .help = "Length of the orbit or path",
         .unit = "seconds",
         .default_text = "that of the file of --path, or 8"},
        {.names = "--fps",
         .commands = {render},
         .value = whole(s.frames_per_second, 1, 240),
         .help = "Frames per second of the orbit or path"}};
    for (option& row : rows) row.group = "Videos";
    return rows;
}

}  // namespace gs::cli
