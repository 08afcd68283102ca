// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "simulate.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "../core/error.hpp"
#include "../model/gaussians.hpp"
#include "decide.hpp"

namespace gs::effects {
namespace {

std::string all_names() {
    std::string names;
    for (const std::string_view name : effect_names) names += (names.empty() ? "" : ", ") + std::string(name);
    return names;
}

std::size_t effect_called(const std::string& name) {
    const auto found = std::ranges::find(effect_names, name);
    if (found == effect_names.end())
        throw error("--effects: there is no effect '" + name + "'; there are " + all_names());
    return static_cast<std::size_t>(found - effect_names.begin());
}

bool has_masks(const scene& scene) {
    return std::ranges::any_of(scene.train, [](const view& v) { return v.pixels.has_mask; });
}

}  // namespace

selection parse_selection(const std::string& text) {
    selection s;
    s.text = text;
    std::istringstream words(text);
    std::string word;
    bool first = true, is_list = false;
    while (std::getline(words, word, ',')) {
        const bool signed_word = word.starts_with('+') || word.starts_with('-');
        if (first && word == "auto") {
        } else if (first && word == "all") {
            s.from = selection::base::all;
        } else if (first && word == "none") {
            s.from = selection::base::none;
        } else if (signed_word && !is_list) {
            s.said[effect_called(word.substr(1))] = word[0] == '+';
        } else if (!signed_word && (first || is_list)) {
            is_list = true;
            s.from = selection::base::none;
            s.said[effect_called(word)] = true;
        } else {
            throw error("--effects " + text + ": '" + word +
                        "' stands in no list: after auto, all or none each effect has + or -, else none has");
        }
        first = false;
    }
    if (first) throw error("--effects is empty: there are auto, all, none, and " + all_names());
    return s;
}

void simulation::leave_out(effect e, const std::string& reason) {
    if (e == effect::sky) sky.clear();
    if (e == effect::depth) depth_fits.clear();
    outcome& o = outcomes[static_cast<std::size_t>(e)];
    o.on = false;
    o.reason = reason;
}

simulation simulate(const scene& scene, const selection& selection, const std::optional<int>& sh_degree) {
    using base = selection::base;
    const bool open = selection.from == base::found;  // what nobody has settled
    const bool asks_direction = open && !selection.of(effect::direction) && !sh_degree;
    const auto not_said = [&](effect e) { return open && !selection.of(e); };
    const auto begins_from_photos = [&](effect e) { return open && selection.of(e).value_or(true); };
    const bool looks = asks_direction || begins_from_photos(effect::exposure) ||
                       begins_from_photos(effect::sky) || not_said(effect::antialiasing) ||
                       not_said(effect::masks) || not_said(effect::depth);
    const evidence found = looks ? gather(scene) : evidence{};
    const std::vector<decision> decisions = looks ? decide(found) : std::vector<decision>{};
    simulation s;
    const auto settle = [&](effect e) {
        simulation::outcome o{std::string(effect_names[static_cast<std::size_t>(e)]),
                              selection.from == base::all, ""};
        if (const auto& said = selection.of(e); said || !open) {
            if (said) o.on = *said;
            o.reason = "--effects " + selection.text;
        } else if (looks) {  // else --sh-degree says
            const decision& d = decisions[static_cast<std::size_t>(e)];
            o.on = d.called_for.value_or(e == effect::direction && effects::sh_degree(found) > 0);
            o.reason = d.evidence;
        }
        s.outcomes.push_back(o);
        return o.on;
    };
    const bool direction = settle(effect::direction);
    if (settle(effect::exposure)) {
        s.exposures.assign(scene.train.size(), 1.0f);
        std::ranges::transform(found.brighter, s.exposures.begin(),
                               [](double log2) { return static_cast<float>(std::exp2(log2)); });
    }
    s.antialiasing = settle(effect::antialiasing);
    if (settle(effect::sky)) {
        s.sky = found.sky.coefficients;
        s.sky.resize(sky_width);
        if (scene.has_alpha) s.leave_out(effect::sky, "photos have transparent parts");
    }
    if (settle(effect::masks) && !has_masks(scene)) s.leave_out(effect::masks, no_masks);
    if (settle(effect::depth)) {
        const depth_evidence depth = looks ? found.depth : compare_depths(scene);
        s.depth_fits = depth.fits;
        if (depth.agreeing == 0) s.leave_out(effect::depth, say(depth));
    }

    s.reviews_bands = asks_direction;
    s.sh_degree = !direction ? 0 : asks_direction ? effects::sh_degree(found) : 3;
    if (sh_degree) {
        s.sh_degree = *sh_degree;
        s.outcomes[0].on = *sh_degree > 0;
        s.outcomes[0].reason = "--sh-degree " + std::to_string(*sh_degree);
    }
    return s;
}

}  // namespace gs::effects
