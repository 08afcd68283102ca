// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "scene_overview.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "../scene/perspective.hpp"

namespace gs::live {
namespace {

using nlohmann::json;

json json_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

json json_of(const camera& c) {
    const glm::dmat3 axes = glm::transpose(c.rotation);
    return {{"position", json_of(c.center())},
            {"forward", json_of(axes[2])},
            {"up", json_of(-axes[1])},
            {"field_of_view", 2 * std::atan(0.5 * c.height / perspective_of(c).fy)}};
}

}  // namespace

std::string scene_json(const orbit& around, const std::vector<view>& views) {
    json scene{{"camera", json_of(around.camera_at(0, 512, 512))},
               {"center", json_of(around.center)},
               {"up", json_of(around.up)},
               {"views", json::array()}};
    for (const view& v : views) {
        scene["views"].push_back(json_of(v.camera));
        scene["views"].back()["name"] = v.name;
    }
    return scene.dump(-1, ' ', true, json::error_handler_t::replace);
}

}  // namespace gs::live
