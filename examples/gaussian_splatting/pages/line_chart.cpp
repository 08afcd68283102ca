// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "line_chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "page_text.hpp"

namespace gs::pages {
namespace {

constexpr double chart_width = 420, chart_height = 230;         ///< in units of the SVG
constexpr double left = 50, right = 12, top = 28, bottom = 38;  ///< margins
constexpr std::size_t most_points = 500, colors = 8;

std::string formatted(const char* format, double value) {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// The range of one axis, extended to multiples of a round step.
struct axis {
    double low = 0, high = 1, step = 1;

    axis(double least, double most) {
        if (!(most > least)) most = least + std::max(1e-6, std::abs(least));
        const double rough = (most - least) / 4, power = std::pow(10, std::floor(std::log10(rough)));
        const double digit = rough / power;
        step = power * (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10);
        low = step * std::floor(least / step);
        high = step * std::ceil(most / step);
    }
    double share(double value) const { return (value - low) / (high - low); }
    int ticks() const { return static_cast<int>(std::lround((high - low) / step)) + 1; }
    double tick(int i) const { return low + i * step; }
};

struct range {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    void include(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

class chart_drawing {
  public:
    chart_drawing(const line_chart& chart, const range& x, const range& y)
        : chart_(chart), x_(x.least, x.most), y_(y.least, y.most) {}

    std::string svg() const {
        std::string text = "<svg class=\"chart\" viewBox=\"0 0 420 230\" role=\"img\" aria-label=\"" +
                           html_escaped(chart_.title) + "\"><text class=\"title\" x=\"0\" y=\"14\">" +
                           html_escaped(chart_.title) + "</text>" + grid();
        for (std::size_t i = 0; i < chart_.curves.size(); ++i) text += line(i);
        return text + "</svg>";
    }

  private:
    std::string px(double x) const {
        return formatted("%.1f", left + (chart_width - left - right) * x_.share(x));
    }
    std::string py(double y) const {
        return formatted("%.1f", chart_height - bottom - (chart_height - top - bottom) * y_.share(y));
    }

    std::string grid() const {
        std::string text;
        for (int i = 0; i < y_.ticks(); ++i) {
            const std::string y = py(y_.tick(i));
            text += "<path class=\"grid\" d=\"M50 " + y + "H408\"/><text class=\"y\" x=\"45\" y=\"" + y +
                    "\" dy=\"4\">" + short_number(y_.tick(i)) + "</text>";
        }
        for (int i = 0; i < x_.ticks(); ++i)
            text += "<text class=\"x\" x=\"" + px(x_.tick(i)) + "\" y=\"208\">" + short_number(x_.tick(i)) +
                    "</text>";
        return text + "<text class=\"x\" x=\"229\" y=\"226\">" + html_escaped(chart_.x_title) + "</text>";
    }

    std::string line(std::size_t which) const {
        const curve& drawn = chart_.curves[which];
        const std::size_t stride = drawn.points.size() / most_points + 1;
        std::string points;
        for (std::size_t i = 0; i < drawn.points.size(); ++i) {
            const auto& [x, y] = drawn.points[i];
            const bool is_last = i + 1 == drawn.points.size();
            if ((i % stride != 0 && !is_last) || !std::isfinite(x) || !std::isfinite(y)) continue;
            points += (points.empty() ? "" : " ") + px(x) + "," + py(y);
        }
        // A single point is a line without length, whose round ends make a dot.
        if (!points.empty() && points.find(' ') == points.npos) points += " " + points;
        return "<polyline class=\"curve" + std::to_string(which % colors) + "\" points=\"" + points +
               "\"><title>" + html_escaped(drawn.label) + "</title></polyline>";
    }

    const line_chart& chart_;
    axis x_, y_;
};

std::string legend_of(const line_chart& chart) {
    std::string text = "<p class=\"legend\">";
    for (std::size_t i = 0; i < chart.curves.size(); ++i)
        text += "<span class=\"key" + std::to_string(i % colors) + "\">" +
                html_escaped(chart.curves[i].label) + "</span> ";
    return text + "</p>";
}

}  // namespace

std::string svg_of(const line_chart& chart) {
    range x, y;
    for (const curve& one : chart.curves)
        for (const auto& [px, py] : one.points)
            if (std::isfinite(px) && std::isfinite(py)) {
                x.include(px);
                y.include(py);
            }
    if (x.least > x.most) return "";
    x.include(0);
    if (chart.begins_at_zero) y.include(0);
    return "<div>" + chart_drawing(chart, x, y).svg() + (chart.curves.size() > 1 ? legend_of(chart) : "") +
           "</div>";
}

std::string short_number(double value) {
    const double size = std::abs(value);
    if (size >= 1e6) return formatted("%.3gM", value / 1e6);
    if (size >= 1e4) return formatted("%.3gk", value / 1e3);
    return formatted("%.4g", size < 1e-12 ? 0 : value);
}

}  // namespace gs::pages
