// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "convert_options.hpp"

#include <charconv>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <string>

namespace gs::cli {
namespace {

using namespace options;

/// Reads six finite numbers such as "-1,-1,0,1,1,2": two opposite corners, in any order.
edit::box read_box(const std::string& word) {
    const auto refuse = [&] {
        throw refused_word("must be six numbers such as -1,-1,0,1,1,2, not '" + word + "'");
    };
    std::vector<double> numbers;
    const char* at = word.data();
    const char* const end = at + word.size();
    while (true) {
        double number = 0;
        const auto [after, problem] = std::from_chars(at, end, number);
        if (problem != std::errc() || !std::isfinite(number)) refuse();
        numbers.push_back(number);
        at = after;
        if (at == end) break;
        if (*at++ != ',' || numbers.size() == 6) refuse();
    }
    if (numbers.size() != 6) refuse();
    const glm::dvec3 a(numbers[0], numbers[1], numbers[2]), b(numbers[3], numbers[4], numbers[5]);
    return {glm::min(a, b), glm::max(a, b)};
}

/// Reads a count of at least 1 such as "100000", or a share above 0 and up to 100 such as "25%".
edit::share read_share_of_gaussians(const std::string& word) {
    if (!word.ends_with('%'))
        return {.count =
                    static_cast<std::size_t>(read_whole(word, 1, std::numeric_limits<std::uint32_t>::max()))};
    double percent = 0;
    const char* const end = word.data() + word.size() - 1;
    const auto [after, problem] = std::from_chars(word.data(), end, percent);
    if (problem != std::errc() || after != end || !(percent > 0 && percent <= 100))
        throw refused_word("must be a count such as 100000 or a share such as 25%, not '" + word + "'");
    return {.percent = percent};
}

/// Six numbers, x0,y0,z0,x1,y1,z1.
option_value box_value(std::optional<edit::box>& member) {
    return {.type = "BOX",
            .range = "x0,y0,z0,x1,y1,z1",
            .read = [&member](const std::string& word) { member = read_box(word); },
            .json =
                [&member] {
                    return member ? nlohmann::ordered_json({member->least.x, member->least.y, member->least.z,
                                                            member->most.x, member->most.y, member->most.z})
                                  : nlohmann::ordered_json(nullptr);
                }};
}

/// A number of Gaussians, or a share of them in percent.
option_value share_of_gaussians(std::optional<edit::share>& member) {
    return {.type = "NUMBER",
            .range = "a count such as 100000, or a share such as 25%",
            .read = [&member](const std::string& word) { member = read_share_of_gaussians(word); },
            .json =
                [&member] {
                    return member ? nlohmann::ordered_json(member->text()) : nlohmann::ordered_json(nullptr);
                }};
}

}  // namespace

std::vector<option> convert_options(settings& s) {
    std::vector<option> rows{
        {.names = "--crop",
         .value = box_value(s.crop),
         .help = "Keeps the Gaussians with centers in this box, in the coordinates of IN",
         .default_text = "none"},
        {.names = "--remove-floaters",
         .value = flag(s.remove_floaters),
         .help = "Removes Gaussians that are almost transparent or larger than the scene, and with --data "
                 "those that fewer than two training views see"},
        {.names = "--decimate",
         .value = share_of_gaussians(s.decimate),
         .help = "Keeps the most important Gaussians, by opacity and size",
         .default_text = "all"},
        {.names = "--max-sh-degree",
         .value = whole(s.export_options.max_sh_degree, 0, 3),
         .help = "Highest degree of the spherical harmonics (SH) that OUT has"},
        {.names = "--sky",
         .value = choice(s.sky),
         .help =
             "Learned background in OUT: auto keeps it if the format can hold it, and otherwise writes it "
             "as Gaussians on a sphere around the model, which all viewers show; none leaves it out"},
        {.names = "--up",
         .value = choice(s.up),
         .help = "Axis that points up in IN; turns the model so that viewers show it upright",
         .default_text = "none; the model is not turned, which suits scenes with -y up"},
        {.names = "--spz-version",
         .value = whole(s.export_options.spz_version, 3, 4),
         .help = "Version of .spz files; some programs read only version 3"}};
    for (option& row : rows) {
        row.group = "Conversion";
        row.commands = {command::convert};
    }
    return rows;
}

}  // namespace gs::cli
