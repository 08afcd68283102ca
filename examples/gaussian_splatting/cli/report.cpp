// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "../core/atomic_file_write.hpp"
#include "../core/write_json.hpp"

namespace gs::cli {

namespace {

using evaluate::view_measure;
using evaluate::view_quality;

/// Returns the measures that a report lists.
std::vector<view_measure> measures_of(const evaluate::held_out_report& report) {
    std::vector<view_measure> listed;
    for (const view_measure& measure : evaluate::view_measures)
        if (measure.is_standard || mean(report.views, measure)) listed.push_back(measure);
    return listed;
}

nlohmann::ordered_json json_of(std::optional<double> value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

std::string text_of(const char* format, std::optional<double> value) {
    return value && std::isfinite(*value) ? number(format, *value) : "";
}

/// Quotes a field as RFC 4180 specifies.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

/// Escapes the characters that would end a cell or a row of a table.
std::string markdown_cell(const std::string& text) {
    std::string cell;
    for (const char c : text) cell += c == '|' ? "\\|" : std::string(1, c == '\n' || c == '\r' ? ' ' : c);
    return cell;
}

}  // namespace

nlohmann::ordered_json to_json(const evaluate::held_out_report& report) {
    const auto listed = measures_of(report);
    nlohmann::ordered_json json;
    for (const view_measure& measure : listed) json[measure.key] = json_of(mean(report.views, measure));
    json["renders_rounded_to_8_bits"] = false;
    if (report.lpips_black) json["lpips_input_range"] = {*report.lpips_black, 1};
    json["views"] = nlohmann::ordered_json::array();
    for (const view_quality& view : report.views) {
        nlohmann::ordered_json& entry = json["views"].emplace_back();
        entry["name"] = view.name;
        for (const view_measure& measure : listed) entry[measure.key] = json_of(measure.of(view));
    }
    return json;
}

std::string to_csv(const evaluate::held_out_report& report) {
    const auto listed = measures_of(report);
    const auto row = [&](const std::string& name, const auto& value_of) {
        std::string text = name;
        for (const view_measure& measure : listed) text += ',' + text_of("%.17g", value_of(measure));
        return text + '\n';
    };
    std::string table = "name";
    for (const view_measure& measure : listed) table += std::string(",") + measure.key;
    table += '\n';
    for (const view_quality& view : report.views)
        table += row(csv_field(view.name), [&](const view_measure& m) { return m.of(view); });
    return table + row("mean", [&](const view_measure& m) { return mean(report.views, m); });
}

std::string to_markdown(const evaluate::held_out_report& report) {
    const auto listed = measures_of(report);
    const auto row = [&](const std::string& name, const auto& value_of) {
        std::string text = "| " + name + " |";
        for (const view_measure& measure : listed)
            text += ' ' + text_of(measure.format, value_of(measure)) + " |";
        return text + '\n';
    };
    std::string table = "| view |", rule = "| --- |";
    for (const view_measure& measure : listed) {
        table += std::string(" ") + measure.heading + " |";
        rule += " ---: |";
    }
    table += '\n' + rule + '\n';
    for (const view_quality& view : report.views)
        table += row(markdown_cell(view.name), [&](const view_measure& m) { return m.of(view); });
    return table + row("**mean**", [&](const view_measure& m) { return mean(report.views, m); });
}

void write_metrics(const std::filesystem::path& folder, const nlohmann::ordered_json& metrics,
                   const evaluate::held_out_report& report) {
    atomic_file_write(folder / "metrics.csv", [&](std::ostream& out) { out << to_csv(report); });
    atomic_file_write(folder / "metrics.md", [&](std::ostream& out) { out << to_markdown(report); });
    write_json(folder / "metrics.json", metrics);
}

std::string optional_measures(const evaluate::held_out_report& report) {
    std::string text;
    if (const auto lpips = report.mean_of("lpips")) text += ", LPIPS " + number("%.4f", *lpips);
    if (const auto fitted = report.mean_of("fitted_psnr"))
        text += ", " + number("%.2f", *fitted) + " dB after fitting exposures";
    if (const auto refined = report.mean_of("refined_psnr"))
        text += ", " + number("%.2f", *refined) + " dB after refining cameras";
    return text;
}

std::string number(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace gs::cli
