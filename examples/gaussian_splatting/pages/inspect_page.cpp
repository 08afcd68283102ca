// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "inspect_page.hpp"

#include <algorithm>
#include <string_view>

#include "page_text.hpp"
#include "picture.hpp"
#include "run_record.hpp"

namespace gs::embedded {
extern const std::string_view inspect_page, report_style;
}  // namespace gs::embedded

namespace gs::pages {
namespace {

std::string verdict_of(const inspected_effect& effect) {
    if (!effect.recommended) return "<span class=\"verdict\">cannot decide</span>";
    return *effect.recommended ? "<span class=\"verdict yes\">recommended</span>"
                               : "<span class=\"verdict\">not recommended</span>";
}

std::string overview(const std::vector<inspected_effect>& effects) {
    std::string text = "<table class=\"overview\"><tr><th>Effect</th><th>Finding</th><th>Evidence</th></tr>";
    for (const inspected_effect& effect : effects) {
        const std::string name = html_escaped(effect.name);
        text += "<tr><td><a href=\"#" + name + "\">" + name + "</a></td><td>" + verdict_of(effect) +
                "</td><td>" + html_escaped(effect.evidence) + "</td></tr>";
    }
    return text + "</table>";
}

std::string fact(const char* title, const std::string& text) {
    return text.empty() ? "" : std::string("<tr><th>") + title + "</th><td>" + text + "</td></tr>";
}

std::string overruling_text(const inspected_effect& effect) {
    if (!effect.obstacle.empty())
        return "This scene cannot be trained with the effect: " + html_escaped(effect.obstacle);
    if (effect.overruled_by.empty()) return "No option; the files of the scene decide";
    std::string text;
    for (const std::string& option : effect.overruled_by)
        text += (text.empty() ? "<code>" : "<br><code>") + html_escaped(option) + "</code>";
    return text;
}

std::string facts_of(const inspected_effect& effect) {
    return "<table class=\"facts\">" + fact("Evidence", html_escaped(effect.evidence)) +
           fact("Recommended if", html_escaped(effect.condition)) +
           fact("Choice", html_escaped(effect.choice)) + fact("Use", html_escaped(effect.costs_and_gains)) +
           fact("Overrule", overruling_text(effect)) + "</table>";
}

/// Returns shapes over the whole photo, in its pixels.
std::string shapes_of(const marked_photo& photo) {
    if (photo.marks.empty()) return "";
    const std::string radius = formatted_number("%.1f", 0.02 * std::max(photo.width, photo.height));
    std::string text = "<svg viewBox=\"0 0 " + std::to_string(photo.width) + " " +
                       std::to_string(photo.height) + "\" preserveAspectRatio=\"none\" aria-hidden=\"true\">";
    const auto number = [](const char* name, double value) {
        return std::string(" ") + name + "=\"" + formatted_number("%.5g", value) + "\"";
    };
    for (const mark& m : photo.marks) {
        const bool is_ring = m.width == 0 && m.height == 0;
        text += is_ring ? "<circle r=\"" + radius + "\"" + number("cx", m.left) + number("cy", m.top)
                        : "<rect" + number("x", m.left) + number("y", m.top) + number("width", m.width) +
                              number("height", m.height);
        text += " class=\"mark" + std::to_string(m.color) + "\"/>";
    }
    return text + "</svg>";
}

void write_photo(std::ostream& out, const marked_photo& photo) {
    out << "<figure><figcaption><b>" << html_escaped(photo.label) << "</b> "
        << html_escaped(shown_view_name(photo.name))
        << (photo.note.empty() ? "" : "<br>" + html_escaped(photo.note))
        << "</figcaption><div class=\"marked\"><img alt=\"" << html_escaped(photo.label) << "\" src=\""
        << data_url(photo.pixels) << "\">" << shapes_of(photo) << "</div></figure>\n";
}

void write_effect(std::ostream& out, const inspected_effect& effect) {
    const std::string name = html_escaped(effect.name);
    out << "<section class=\"evidence\" id=\"" << name << "\"><h2>" << name << " " << verdict_of(effect)
        << "</h2>\n"
        << facts_of(effect);
    out << "<div class=\"charts\">";
    for (const line_chart& chart : effect.charts) out << svg_of(chart);
    out << "</div>\n<div class=\"views\">\n";
    for (const marked_photo& photo : effect.photos) write_photo(out, photo);
    out << "</div></section>\n";
}

}  // namespace

void write_inspect_page(std::ostream& out, const inspection& content) {
    fill_template(out, embedded::inspect_page,
                  {{"title", text_part("Effects of " + html_escaped(content.scene))},
                   {"style", text_part(std::string(embedded::report_style))},
                   {"photos", text_part(std::to_string(content.photos))},
                   {"overview", text_part(overview(content.effects))},
                   {"effects", [&](std::ostream& to) {
                        for (const inspected_effect& effect : content.effects) write_effect(to, effect);
                    }}});
}

}  // namespace gs::pages
