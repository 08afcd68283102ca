// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "page_options.hpp"

#include <string>

namespace gs::cli {

namespace {

using namespace options;

/// Words that name folders.
option_value folders(std::vector<std::string>& member) {
    return {.type = "FOLDER...",
            .range = "",
            .read = [&member](const std::string& word) { member.push_back(word); },
            .json = [&member] { return nlohmann::ordered_json(member); },
            .is_list = true};
}

}  // namespace

std::vector<option> page_options(settings& s) {
    using enum command;
    return {{.names = "runs",
             .group = "Output",
             .commands = {compare},
             .value = folders(s.runs),
             .help = "Output folders of train to compare, at least two",
             .required = {compare}},
            {.names = "-o,--output",
             .group = "Output",
             .commands = {compare},
             .value = text(s.output, "FILE"),
             .help = "Web page to write",
             .default_text = "compare.html"},
            {.names = "--html",
             .group = "Output",
             .commands = {inspect},
             .value = text(s.html, "FILE"),
             .help = "Web page that shows the evidence for each effect: charts and marked photos",
             .default_text = "none; nothing is written"},
            {.names = "--no-viewer",
             .group = "Output",
             .commands = {train},
             .value = flag(s.no_viewer),
             .help = "Leaves out viewer.html, the page that shows the model in a browser"},
            {.names = "--viewer-size",
             .group = "Output",
             .commands = {train},
             .value = byte_size(s.viewer_size),
             .help = "Largest size of viewer.html; a larger model is shown without its least important "
                     "Gaussians",
             .default_text = "64MB",
             .excludes = {"--no-viewer"},
             .is_rare = true}};
}

}  // namespace gs::cli
