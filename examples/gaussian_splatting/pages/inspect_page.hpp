// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "line_chart.hpp"
#include "marked_photo.hpp"

namespace gs::pages {

/// An effect, and the evidence for or against it.
struct inspected_effect {
    std::string name;
    std::optional<bool> recommended;  ///< empty if the photos do not allow a decision
    std::string evidence;             ///< a phrase with its figures
    std::string condition;            ///< follows "recommended if"; empty if there is none
    std::string choice;               ///< what training does
    std::string costs_and_gains;
    std::vector<std::string> overruled_by;  ///< options of train
    std::string obstacle;                   ///< why no option can turn it on, or empty
    std::vector<line_chart> charts;
    std::vector<marked_photo> photos;
};

struct inspection {
    std::string scene;  ///< its name, without folders
    std::size_t photos = 0;
    std::vector<inspected_effect> effects;
};

/// Writes a page about the effects that a scene calls for, with charts and photos as evidence. The
/// page needs no other files and no JavaScript. Texts are escaped, and names of photos appear
/// without the folders outside of the scene.
void write_inspect_page(std::ostream& out, const inspection& content);

}  // namespace gs::pages
