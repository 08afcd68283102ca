// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "run_record.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

namespace gs::pages {
namespace {

using nlohmann::ordered_json;

const ordered_json* member(const ordered_json& json, const std::string& key) {
    if (!json.is_object()) return nullptr;
    const auto found = json.find(key);
    return found == json.end() ? nullptr : &*found;
}

/// Returns one column of the history, or nothing if it is not an array.
const ordered_json* column(const ordered_json& metrics, const std::string& key) {
    const ordered_json* const history = member(metrics, "history");
    const ordered_json* const found = history ? member(*history, key) : nullptr;
    return found && found->is_array() ? found : nullptr;
}

curve history_curve(const run_record& run, const std::string& x_key, const std::string& y_key) {
    curve drawn{run.name, {}};
    const ordered_json *const x = column(run.metrics, x_key), *const y = column(run.metrics, y_key);
    for (std::size_t i = 0; x && y && i < std::min(x->size(), y->size()); ++i)
        if ((*x)[i].is_number() && (*y)[i].is_number())
            drawn.points.emplace_back((*x)[i].get<double>(), (*y)[i].get<double>());
    return drawn;
}

}  // namespace

std::optional<double> number_in(const ordered_json& json, const std::vector<std::string>& path) {
    const ordered_json* at = &json;
    for (const std::string& key : path)
        if (at) at = member(*at, key);
    return at && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

std::string text_in(const ordered_json& json, const std::string& key) {
    const ordered_json* const found = member(json, key);
    return found && found->is_string() ? found->get<std::string>() : "";
}

std::vector<line_chart> charts_of(const std::vector<run_record>& runs) {
    constexpr std::array<std::pair<const char*, const char*>, 3> rows{
        {{"loss", "Loss"}, {"psnr", "PSNR of training views (dB)"}, {"gaussians", "Gaussians"}}};
    constexpr std::array<std::pair<const char*, const char*>, 2> columns{
        {{"iteration", "iterations"}, {"seconds", "seconds"}}};
    std::vector<line_chart> charts;
    for (const auto& [y_key, title] : rows)
        for (const auto& [x_key, x_title] : columns) {
            const bool begins_at_zero = y_key != std::string_view("psnr");
            line_chart& chart = charts.emplace_back(line_chart{title, x_title, {}, begins_at_zero});
            for (const run_record& run : runs) chart.curves.push_back(history_curve(run, x_key, y_key));
        }
    return charts;
}

std::string shown_setting(const ordered_json& value) {
    if (value.is_array()) {
        std::string text;
        for (const ordered_json& element : value) text += (text.empty() ? "" : " ") + shown_setting(element);
        return text;
    }
    if (value.is_number_float()) return formatted_number("%.6g", value.get<double>());
    if (!value.is_string())
        return value.is_null() ? "" : value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    std::string text = value.get<std::string>();
    while (text.size() > 1 && text.ends_with('/')) text.pop_back();
    return text.substr(text.find_last_of('/') + 1);
}

std::string shown_view_name(const std::string& name) {
    const bool is_outside = name.starts_with('/') || name.starts_with("../");
    return is_outside ? name.substr(name.find_last_of('/') + 1) : name;
}

const std::vector<metric>& reported_metrics() {
    static const std::vector<metric> all{{{"psnr"}, "Held-out PSNR (dB)", "%.2f", 1},
                                         {{"ssim"}, "Held-out SSIM", "%.4f", 1},
                                         {{"lpips"}, "Held-out LPIPS", "%.4f", -1},
                                         {{"training_psnr"}, "Training PSNR (dB)", "%.2f", 1},
                                         {{"gaussians"}, "Gaussians", "%.0f", 0},
                                         {{"iterations"}, "Iterations", "%.0f", 0},
                                         {{"seconds", "train"}, "Training (s)", "%.1f", -1},
                                         {{"seconds", "load"}, "Loading (s)", "%.1f", -1},
                                         {{"seconds", "evaluate"}, "Evaluation (s)", "%.1f", -1},
                                         {{"peak_device_bytes"}, "Device memory (MB)", "%.0f", -1, 1e-6},
                                         {{"peak_host_bytes"}, "Host memory (MB)", "%.0f", -1, 1e-6}};
    return all;
}

std::string formatted_number(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::vector<std::pair<std::size_t, const char*>> typical_views(const std::vector<double>& psnr) {
    std::vector<std::size_t> order(psnr.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return psnr[i]; });
    if (order.empty()) return {};
    std::vector<std::pair<std::size_t, const char*>> chosen{{order.front(), "Worst view"}};
    if (order.size() > 2) chosen.emplace_back(order[order.size() / 2], "Median view");
    if (order.size() > 1) chosen.emplace_back(order.back(), "Best view");
    return chosen;
}

}  // namespace gs::pages
