// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "view_options.hpp"

#include <string>

#include "../live/http_server.hpp"

namespace gs::cli {
namespace {

using namespace options;
using enum command;

/// The port of the live view. Without one, `implied` stands for the default.
option_value viewer_port(std::optional<int>& member, const std::string& implied) {
    option_value port = whole(member, 0, 65535);
    port.type = implied.empty() ? "PORT" : "[PORT]";
    port.implied = implied;
    return port;
}

}  // namespace

std::vector<option> view_options(settings& s) {
    const std::string free_port =
        std::to_string(live::server_address::default_port) + ", or a free port if it is in use";
    const std::string about_host = "Address that the page is served at; 0.0.0.0 lets other machines reach it";
    std::vector<option> rows{
        {.names = "--viewer",
         .commands = {train},
         .value = viewer_port(s.viewer, "0"),
         .help = "Shows the training in a browser: prints the URL of a page that this program serves; "
                 "without PORT, uses " +
                 free_port,
         .default_text = "none; there is no page",
         .is_recorded = false},
        {.names = "--port",
         .commands = {view},
         .value = viewer_port(s.viewer, ""),
         .help = "Port of the page",
         .default_text = free_port},
        {.names = "--viewer-host",
         .commands = {train},
         .value = text(s.viewer_host, "ADDRESS"),
         .help = about_host,
         .needs = {"--viewer"},
         .is_rare = true,
         .is_recorded = false},
        {.names = "--viewer-host",
         .commands = {view},
         .value = text(s.viewer_host, "ADDRESS"),
         .help = about_host}};
    for (option& row : rows) row.group = "Live view";
    return rows;
}

}  // namespace gs::cli
