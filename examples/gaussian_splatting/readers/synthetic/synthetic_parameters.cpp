// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "synthetic_parameters.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "../../core/error.hpp"

namespace gs {
namespace {

struct parameter {
    const char* name;
    double synthetic_parameters::*value;
    double least, most;
    bool is_whole = false;
};
constexpr parameter parameters[] = {{"gloss", &synthetic_parameters::gloss, 0, 1},
                                    {"exposure", &synthetic_parameters::exposure, 0, 2},
                                    {"scales", &synthetic_parameters::scales, 1, 16},
                                    {"distance", &synthetic_parameters::distance, 0.25, 16},
                                    {"passers", &synthetic_parameters::passers, 0, 0.5},
                                    {"moving", &synthetic_parameters::moving, 0, 1},
                                    {"blur", &synthetic_parameters::blur, 0, 32},
                                    {"shutter", &synthetic_parameters::shutter, -32, 32},
                                    {"vignetting", &synthetic_parameters::vignetting, 0, 0.8},
                                    {"response", &synthetic_parameters::response, 0, 1},
                                    {"sky", &synthetic_parameters::sky, 0, 1},
                                    {"walls", &synthetic_parameters::walls, 0, 1},
                                    {"fisheye", &synthetic_parameters::fisheye, 0, 190},
                                    {"panorama", &synthetic_parameters::panorama, 0, 1, true},
                                    {"depths", &synthetic_parameters::depths, 0, 10},
                                    {"points", &synthetic_parameters::points, 1, 100000, true},
                                    {"views", &synthetic_parameters::views, 1, 48, true},
                                    {"poses", &synthetic_parameters::poses, 0, 5},
                                    {"noise", &synthetic_parameters::noise, 0, 0.5}};

const parameter& parameter_called(const std::string& name) {
    std::string known;
    for (const parameter& p : parameters) {
        if (name == p.name) return p;
        known += (known.empty() ? "" : ", ") + std::string(p.name);
    }
    throw error("a synthetic scene has no parameter '" + name + "'; there are: " + known);
}

}  // namespace

synthetic_parameters parse_synthetic(const std::string& text) {
    synthetic_parameters result;
    std::istringstream words(text);
    std::getline(words, result.world, ',');
    if (text.ends_with(',')) parameter_called("");
    std::set<std::string> said;
    for (std::string word; std::getline(words, word, ',');) {
        const std::string name = word.substr(0, word.find('='));
        const parameter& p = parameter_called(name);
        if (!said.insert(name).second)
            throw error("a synthetic scene has one '" + name + "', not several: " + text);
        const std::string number = word.substr(std::min(word.size(), name.size() + 1));
        double& value = result.*p.value;
        const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), value);
        if (problem != std::errc() || end != number.data() + number.size() ||
            !(value >= p.least && value <= p.most) || (p.is_whole && value != std::floor(value))) {
            char range[64];
            std::snprintf(range, sizeof range, "%g to %g", p.least, p.most);
            throw error("the '" + name + "' of a synthetic scene is a " + (p.is_whole ? "whole " : "") +
                        "number from " + range + ", not '" + number + "'");
        }
    }
    if (result.fisheye > 0 && result.panorama > 0)
        throw error("a synthetic scene has either a 'fisheye' or a 'panorama', not both: " + text);
    if (result.vignetting > 0 && result.panorama > 0)
        throw error("a synthetic scene has either 'vignetting' or a 'panorama', not both: " + text);
    if (result.response > 0 && result.panorama > 0)
        throw error("a synthetic scene has either a 'response' or a 'panorama', not both: " + text);
    if ((result.blur > 0 || result.shutter != 0) && result.panorama > 0)
        throw error("a synthetic scene has either 'blur' and 'shutter' or a 'panorama', not both: " + text);
    if (result.sky > 0 && result.walls > 0)
        throw error("a synthetic scene has either a 'sky' or 'walls', not both: " + text);
    return result;
}

}  // namespace gs
