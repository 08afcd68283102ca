// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "explanation.hpp"

#include "../pages/picture.hpp"
#include "../scene/view_photo.hpp"

namespace gs::features {

pages::marked_photo shown_photo(const view& of, std::string label, std::string note,
                                std::vector<pages::mark> marks) {
    return {.label = std::move(label),
            .name = of.name,
            .note = std::move(note),
            .pixels = pages::thumbnail(view_photo(of).pixels()),
            .width = of.camera.width,
            .height = of.camera.height,
            .marks = std::move(marks)};
}

pages::mark ring_around(const observation& seen, int color) {
    return {.left = seen.place.x, .top = seen.place.y, .color = color};
}

pages::curve curve_of_photos(std::string label, const std::vector<double>& values) {
    pages::curve made{std::move(label), {}};
    for (std::size_t v = 0; v < values.size(); ++v)
        made.points.emplace_back(static_cast<double>(v + 1), values[v]);
    return made;
}

pages::curve level_line(std::string label, double end, double value) {
    return {std::move(label), {{0, value}, {end, value}}};
}

}  // namespace gs::features
