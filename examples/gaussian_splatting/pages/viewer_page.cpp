// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "viewer_page.hpp"

#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "../scene/perspective.hpp"
#include "base64.hpp"
#include "page_text.hpp"

namespace gs::embedded {
extern const std::string_view viewer_page, viewer_splat, viewer_sort_worker, viewer_shaders, viewer_renderer,
    viewer_camera, viewer_controls, viewer_main;
}  // namespace gs::embedded

namespace gs::pages {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view before_part = "<script type=\"text/plain\" class=\"splat\">",
                           after_part = "</script>\n";

ordered_json json_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

ordered_json json_of(const camera& taken_with) {
    const camera view = perspective_of(taken_with);
    const glm::dmat3 axes = glm::transpose(view.rotation);  // its columns are the rows of the rotation
    return {{"width", view.width},
            {"height", view.height},
            {"focal", {view.fx, view.fy}},
            {"center", {view.cx, view.cy}},
            {"axes", {json_of(axes[0]), json_of(axes[1]), json_of(axes[2])}},
            {"position", json_of(view.center())}};
}

std::string scene_text(const viewer_scene& scene) {
    ordered_json views = ordered_json::array();
    for (const camera& view : scene.views) views.push_back(json_of(view));
    return script_json({{"views", views},
                        {"up", json_of(scene.up)},
                        {"pivot", json_of(scene.pivot)},
                        {"radius", scene.radius},
                        {"near", scene.near_plane},
                        {"background", scene.background},
                        {"antialiased", scene.antialiased},
                        {"sky", scene.sky},
                        {"gaussians", scene.gaussians}});
}

void write_script(std::ostream& out) {
    for (const std::string_view part :
         {embedded::viewer_splat, embedded::viewer_sort_worker, embedded::viewer_shaders,
          embedded::viewer_renderer, embedded::viewer_camera, embedded::viewer_controls,
          embedded::viewer_main})
        out << part;
}

}  // namespace

void write_viewer_page(std::ostream& out, const viewer_scene& scene,
                       const std::function<void(std::ostream&)>& write_splat) {
    fill_template(
        out, embedded::viewer_page,
        {{"title", text_part(html_escaped(scene.title))},
         {"scene", text_part(scene_text(scene))},
         {"splat", [&](std::ostream& to) { write_base64(to, write_splat, before_part, after_part); }},
         {"script", write_script}});
}

std::uint64_t viewer_page_size(const viewer_scene& scene, std::uint64_t splat_bytes) {
    std::ostringstream page;
    write_viewer_page(page, scene, [](std::ostream&) {});
    const std::uint64_t parts = splat_bytes / (3U << 20) + 1;
    return page.str().size() + base64_size(splat_bytes) + parts * (before_part.size() + after_part.size());
}

}  // namespace gs::pages
