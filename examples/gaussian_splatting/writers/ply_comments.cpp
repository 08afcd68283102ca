// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "ply_comments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"
#include "ply_header.hpp"

namespace gs {
namespace {

constexpr std::string_view render_mode = "SplatRenderMode:", mip = "mip";
constexpr std::string_view sky_harmonics = "SkyHarmonics:";

void read_sky(std::string_view numbers, const std::string& file, gaussians& model) {
    const auto fail = [&](const std::string& what) { throw error(file + ": its sky has " + what); };
    model.sky.clear();
    for (std::string_view word = take_ply_word(numbers); !word.empty(); word = take_ply_word(numbers)) {
        float value = 0;
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (problem != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
            fail("'" + sanitize_for_message(word) + "', which is not a finite number");
        if (model.sky.size() == sky_width) fail("more than " + std::to_string(sky_width) + " numbers");
        model.sky.push_back(value);
    }
    if (model.sky.size() < sky_width)
        fail(std::to_string(model.sky.size()) + " numbers instead of " + std::to_string(sky_width));
}

}  // namespace

std::string ply_comments(const gaussians& model) {
    std::string comments;
    if (model.antialiased) comments += "comment " + std::string(render_mode) + " " + std::string(mip) + "\n";
    if (model.sky.empty()) return comments;
    comments += "comment " + std::string(sky_harmonics);
    for (const float x : model.sky) {
        char text[32];
        comments += ' ' + std::string(text, std::to_chars(text, text + sizeof text, x).ptr);
    }
    return comments + '\n';
}

void read_ply_comment(std::string_view line, const std::string& file, gaussians& model) {
    take_ply_word(line);
    const std::string_view key = take_ply_word(line);
    if (key == sky_harmonics) read_sky(line, file, model);
    if (key == render_mode && take_ply_word(line) == mip) model.antialiased = true;
}

void require_finite_sky(const std::filesystem::path& file, const gaussians& model) {
    if (!std::ranges::all_of(model.sky, [](float x) { return std::isfinite(x); }))
        throw error("cannot write " + file.string() + ": its sky is not finite");
}

}  // namespace gs
