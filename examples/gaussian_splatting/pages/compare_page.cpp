// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "compare_page.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "page_text.hpp"
#include "picture.hpp"

namespace gs::embedded {
extern const std::string_view compare_page, report_style, report_slider;
}  // namespace gs::embedded

namespace gs::pages {
namespace {

using nlohmann::ordered_json;

std::string heading_row(const std::vector<run_record>& runs) {
    std::string text = "<tr><th></th>";
    for (const run_record& run : runs) text += "<th>" + html_escaped(run.name) + "</th>";
    return text + "</tr>";
}

/// Returns a row of numbers, the best of which is marked. Returns an empty text if no run has one.
std::string metric_row(const std::vector<run_record>& runs, const metric& m) {
    std::vector<std::optional<double>> values;
    for (const run_record& run : runs) values.push_back(number_in(run.metrics, m.path));
    std::optional<double> best;
    for (const auto& value : values)
        if (value && (!best || m.better * *value > m.better * *best)) best = value;
    if (!best || (*best == 0 && m.factor != 1)) return "";
    const bool all_equal = std::ranges::all_of(values, [&](const auto& value) { return value == best; });
    std::string text = "<tr><th>" + html_escaped(m.title) + "</th>";
    for (const auto& value : values) {
        const bool is_marked = m.better != 0 && value == best && !all_equal;
        text += std::string("<td") + (is_marked ? " class=\"best\">" : ">") +
                (value ? formatted_number(m.format, *value * m.factor) : "") + "</td>";
    }
    return text + "</tr>";
}

std::string compared_metrics(const std::vector<run_record>& runs) {
    std::string text = "<div class=\"wide\"><table class=\"numbers\">" + heading_row(runs);
    for (const metric& m : reported_metrics()) text += metric_row(runs, m);
    return text + "</table></div>";
}

std::string compared_charts(const std::vector<run_record>& runs) {
    std::string text;
    for (const line_chart& chart : charts_of(runs)) text += svg_of(chart);
    return text.empty() ? "<p>No run has curves.</p>" : text;
}

std::string value_in(const run_record& run, const std::string& key) {
    return run.settings.is_object() && run.settings.contains(key) ? shown_setting(run.settings[key]) : "";
}

/// Returns a table of all settings. Rows that differ come first and are marked.
std::string compared_settings(const std::vector<run_record>& runs) {
    std::vector<std::string> keys;
    std::set<std::string> seen{"given", "output", "save_iterations", "log_level"};
    for (const run_record& run : runs)
        if (run.settings.is_object())
            for (const auto& [key, value] : run.settings.items())
                if (seen.insert(key).second) keys.push_back(key);
    std::string differing, equal;
    for (const std::string& key : keys) {
        const std::string first = value_in(runs.front(), key);
        std::string cells;
        bool differs = false;
        for (const run_record& run : runs) {
            differs = differs || value_in(run, key) != first;
            cells += "<td>" + html_escaped(value_in(run, key)) + "</td>";
        }
        (differs ? differing : equal) += std::string("<tr") + (differs ? " class=\"differs\"" : "") +
                                         "><th>" + html_escaped(key) + "</th>" + cells + "</tr>";
    }
    const std::string begin = "<div class=\"wide\"><table>" + heading_row(runs), end = "</table></div>";
    return (differing.empty() ? "<p>The runs have the same settings.</p>" : begin + differing + end) +
           "<details><summary>Equal settings</summary>" + begin + equal + end + "</details>";
}

void write_choice(std::ostream& out, const char* side, std::size_t selected,
                  const std::vector<run_record>& runs) {
    out << "<label>" << side << " <select>";
    for (std::size_t i = 0; i <= runs.size(); ++i)
        out << "<option" << (i == selected ? " selected>" : ">")
            << (i == 0 ? "Photo" : html_escaped(runs[i - 1].name)) << "</option>";
    out << "</select></label>";
}

void write_compared_view(std::ostream& out, const compared_view& view, const std::vector<run_record>& runs) {
    out << "<figure class=\"choice\"><figcaption><b>" << html_escaped(view.label) << "</b> "
        << html_escaped(shown_view_name(view.name))
        << "</figcaption><div class=\"pair\"><img alt=\"Left image\" src=\"" << data_url(view.renders.front())
        << "\"><img class=\"over\" alt=\"Right image\" src=\"" << data_url(view.renders[1])
        << "\"><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"Share of the left "
           "image\"></div><p class=\"sides\">";
    write_choice(out, "Left", 1, runs);
    write_choice(out, "Right", 2, runs);
    out << "</p><div hidden><img alt=\"\" src=\"" << data_url(view.photo) << "\">";
    for (const image& render : view.renders) out << "<img alt=\"\" src=\"" << data_url(render) << "\">";
    out << "</div></figure>\n";
}

}  // namespace

void write_compare_page(std::ostream& out, const std::vector<run_record>& runs,
                        const std::vector<compared_view>& views) {
    const std::string note =
        views.empty() ? "The runs have no held-out view in common. Train them with <code>--eval</code>."
                      : "These views are held out. Move the line, and choose the images on its sides.";
    fill_template(out, embedded::compare_page,
                  {{"title", text_part("Comparison of " + std::to_string(runs.size()) + " runs")},
                   {"style", text_part(std::string(embedded::report_style))},
                   {"slider", text_part(std::string(embedded::report_slider))},
                   {"metrics", text_part(compared_metrics(runs))},
                   {"views_note", text_part(note)},
                   {"views",
                    [&](std::ostream& to) {
                        for (const compared_view& view : views) write_compared_view(to, view, runs);
                    }},
                   {"charts", text_part(compared_charts(runs))},
                   {"settings", text_part(compared_settings(runs))}});
}

}  // namespace gs::pages
