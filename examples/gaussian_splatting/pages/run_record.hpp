// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../image/image.hpp"
#include "line_chart.hpp"

namespace gs::pages {

/// What a run has written about itself. Files of other runs are not trusted: the functions below
/// ignore values of a wrong type.
struct run_record {
    std::string name;  ///< without folders
    nlohmann::ordered_json metrics, settings;
};

/// The images of a view. All have the same size.
struct view_images {
    std::string name;
    std::string label;             ///< such as "Worst view"
    std::optional<double> psnr{};  ///< in dB
    image photo, render;
};

/// Returns a number of metrics.json, such as {"seconds", "train"}, if it exists.
std::optional<double> number_in(const nlohmann::ordered_json& json, const std::vector<std::string>& path);

/// Returns a text of a JSON object, or an empty one.
std::string text_in(const nlohmann::ordered_json& json, const std::string& key);

/// Returns the history of a run as curves: loss, PSNR and number of Gaussians, against iterations and
/// against seconds. Each chart has a curve per run.
std::vector<line_chart> charts_of(const std::vector<run_record>& runs);

/// Returns a value of settings.json for people. Removes folders from paths, because they tell about
/// the machine.
std::string shown_setting(const nlohmann::ordered_json& value);

/// Returns the name of a view for people. Removes the folders of a photo outside of the scene.
std::string shown_view_name(const std::string& name);

/// A number of metrics.json that reports list.
struct metric {
    std::vector<std::string> path;
    const char* title;
    const char* format;  ///< for printf
    int better;          ///< 1 if larger values are better, -1 if smaller ones are, or 0
    double factor = 1;   ///< of the number shown
};

/// Returns the numbers that reports list, in their order.
const std::vector<metric>& reported_metrics();

/// Returns a number with a format for printf.
std::string formatted_number(const char* format, double value);

/// Returns the chosen views by their PSNR: worst, median and best, as indices. Returns fewer if
/// there are fewer views.
std::vector<std::pair<std::size_t, const char*>> typical_views(const std::vector<double>& psnr);

}  // namespace gs::pages
