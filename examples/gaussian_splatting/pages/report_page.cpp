// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "report_page.hpp"

#include <algorithm>
#include <string_view>

#include "page_text.hpp"
#include "picture.hpp"

namespace gs::embedded {
extern const std::string_view report_page, report_style, report_slider;
}  // namespace gs::embedded

namespace gs::pages {
namespace {

using nlohmann::ordered_json;

std::string metrics_table(const ordered_json& metrics) {
    std::string text = "<dl class=\"metrics\">";
    for (const metric& m : reported_metrics())
        if (const auto value = number_in(metrics, m.path); value && (m.factor == 1 || *value > 0))
            text += "<div><dt>" + html_escaped(m.title) + "</dt><dd>" +
                    formatted_number(m.format, *value * m.factor) + "</dd></div>";
    return text + "</dl>";
}

std::string summary_of(const ordered_json& metrics) {
    return "Trained on " + html_escaped(text_in(metrics, "device")) + ".";
}

void write_view(std::ostream& out, const view_images& view) {
    const std::string psnr = view.psnr ? ", " + formatted_number("%.2f dB", *view.psnr) : "";
    out << "<figure><figcaption><b>" << html_escaped(view.label) << "</b> "
        << html_escaped(shown_view_name(view.name)) << psnr
        << "</figcaption><div class=\"pair\"><img alt=\"Photo\" src=\"" << data_url(view.photo)
        << "\"><img class=\"over\" alt=\"Render\" src=\"" << data_url(view.render)
        << "\"><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"Share of the "
           "photo\"></div>"
        << "<p class=\"sides\"><span>Photo</span><span>Render</span></p><img alt=\"Error\" src=\""
        << data_url(error_image(view.photo, view.render, view.name))
        << "\"><figcaption>Error: black is none, yellow is a quarter of the range or "
           "more</figcaption></figure>\n";
}

std::string views_note(const report& content) {
    if (content.views.empty()) return "The run has no views.";
    return content.are_held_out
               ? "These views are held out: training has not seen their photos."
               : "These are <b>training views</b>, because the run was made without <code>--eval</code>. "
                 "Their quality says little about other views.";
}

std::string charts_text(const report& content) {
    std::string text;
    for (const line_chart& chart : charts_of({content.run})) text += svg_of(chart);
    return text.empty() ? "<p>The run was too short for curves.</p>" : text;
}

/// Returns rows with a bar for each time, whose widths add up to 100 %.
std::string bars(const std::vector<std::pair<std::string, double>>& times, const char* unit) {
    double sum = 0;
    for (const auto& [name, time] : times) sum += time;
    std::string text = "<table class=\"bars\">";
    for (const auto& [name, time] : times)
        text += "<tr><th>" + html_escaped(name) + "</th><td>" + short_number(time) + " " + unit +
                "</td><td><span style=\"width:" + formatted_number("%.1f", sum > 0 ? 100 * time / sum : 0) +
                "%\"></span></td></tr>";
    return text + "</table>";
}

std::string times_text(const ordered_json& metrics) {
    std::vector<std::pair<std::string, double>> parts, stages;
    for (const char* part : {"load", "train", "evaluate"})
        if (const auto seconds = number_in(metrics, {"seconds", part})) parts.emplace_back(part, *seconds);
    if (metrics.contains("stages") && metrics["stages"].is_object())
        for (const auto& [name, stage] : metrics["stages"].items())
            if (const auto ms = number_in(stage, {"milliseconds"})) {
                stages.emplace_back(name, *ms);
                std::ranges::replace(stages.back().first, '_', ' ');
            }
    std::string text = "<h3>Whole run</h3>" + bars(parts, "s");
    if (!stages.empty()) text += "<h3>Stages of an iteration</h3>" + bars(stages, "ms");
    return text;
}

std::string effects_text(const ordered_json& metrics) {
    std::string text =
        "<div class=\"wide\"><table><tr><th>Effect</th><th>Simulated</th><th>Evidence</th></tr>";
    if (metrics.contains("effects") && metrics["effects"].is_array())
        for (const ordered_json& effect : metrics["effects"]) {
            const bool is_on = effect.is_object() && effect.value("on", ordered_json()) == true;
            text += "<tr><td>" + html_escaped(text_in(effect, "name")) + "</td><td>" +
                    (is_on ? "yes" : "no") + "</td><td>" + html_escaped(text_in(effect, "reason"));
            if (effect.is_object() && effect.contains("reason_half_way"))
                text += "; half-way: " + html_escaped(text_in(effect, "reason_half_way"));
            text += "</td></tr>";
        }
    return text + "</table></div>";
}

std::string settings_text(const ordered_json& settings) {
    std::string text = "<div class=\"wide\"><table>";
    for (const auto& [key, value] : settings.items())
        if (key != "given")
            text += "<tr><th>" + html_escaped(key) + "</th><td>" + html_escaped(shown_setting(value)) +
                    "</td></tr>";
    return text + "</table></div>";
}

/// Returns a word that shells read as it is.
std::string shell_word(const std::string& word) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,.%@/";
    if (!word.empty() && word.find_first_not_of(plain) == word.npos) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

}  // namespace

std::string command_of(const ordered_json& settings) {
    std::string command = "gaussian_splatting train";
    if (!settings.contains("given") || !settings["given"].is_object()) return command;
    for (const auto& [key, value] : settings["given"].items()) {
        if (value == false || value.is_null()) continue;
        std::string name = key;
        std::ranges::replace(name, '_', '-');
        command += " --" + name;
        if (value == true) continue;
        for (const ordered_json& word : value.is_array() ? value : ordered_json::array({value}))
            command += " " + shell_word(shown_setting(word));
    }
    return command;
}

void write_report_page(std::ostream& out, const report& content) {
    const ordered_json& metrics = content.run.metrics;
    const std::string title = "Report: " + content.run.name;
    fill_template(out, embedded::report_page,
                  {{"title", text_part(html_escaped(title))},
                   {"style", text_part(std::string(embedded::report_style))},
                   {"slider", text_part(std::string(embedded::report_slider))},
                   {"summary", text_part(summary_of(metrics))},
                   {"metrics", text_part(metrics_table(metrics))},
                   {"views_note", text_part(views_note(content))},
                   {"views",
                    [&](std::ostream& to) {
                        for (const view_images& view : content.views) write_view(to, view);
                    }},
                   {"charts", text_part(charts_text(content))},
                   {"times", text_part(times_text(metrics))},
                   {"effects", text_part(effects_text(metrics))},
                   {"command", text_part(html_escaped(command_of(content.run.settings)))},
                   {"settings", text_part(settings_text(content.run.settings))}});
}

}  // namespace gs::pages
