// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "training_effects.hpp"

#include "../core/error.hpp"
#include "../features/sh_degree/sh_degree_feature.hpp"

namespace gs::cli {

using nlohmann::ordered_json;

features::feature_set resolve_effects(const settings& s, const scene& scene, const command_context& context) {
    const std::string background = "--background " + name_of(s.background);
    std::vector<features::selected_feature> fixed;
    if (s.sh_degree) fixed.push_back(features::explicit_sh_degree(*s.sh_degree));
    features::feature_set features = features::resolve(scene, s.effects, fixed);
    if (s.background != background_kind::automatic) features.turn_off("sky", background);
    for (const auto& f : features.all()) context.say(f.name + (f.on ? " on: " : " off: ") + f.reason);
    const bool changes_with_exposures =
        s.background == background_kind::white || s.background == background_kind::random;
    if (features.is_on("exposure") && changes_with_exposures)
        throw error(background +
                    " does not go with exposures, which would change it with the photos: use --background "
                    "black or --effects -exposure");
    return features;
}

std::string effects_in_use(const features::feature_set& features) {
    std::string names;
    for (const auto& f : features.all())
        if (f.on) names += (names.empty() ? "" : ",") + f.name;
    return names.empty() ? "none" : names;
}

ordered_json effects_json(const settings& s, const scene& scene, const train::train_options& options,
                          const train::train_result& result) {
    ordered_json all = ordered_json::array();
    for (const auto& f : options.features.all()) {
        all.push_back({{"name", f.name}, {"on", f.on}, {"reason", f.reason}});
        if (const auto report = result.feature_reports.find(f.name); report != result.feature_reports.end())
            all.back().update(report->second);
    }
    all.push_back({{"name", "background"},
                   {"on", scene.has_alpha || options.background.random},
                   {"reason", !scene.has_alpha ? "--background " + name_of(s.background)
                              : !options.features.is_on("exposure")
                                  ? "the photos have transparent parts"
                                  : "the photos have transparent parts; black, since they have exposures"}});
    return all;
}

}  // namespace gs::cli
