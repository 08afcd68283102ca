// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "camera_models.hpp"

#include <algorithm>
#include <iterator>

#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"

namespace gs {
namespace {

constexpr camera_model camera_models[] = {
    {0, "SIMPLE_PINHOLE", false, 0},
    {1, "PINHOLE", true, 0},
    {2, "SIMPLE_RADIAL", false, 1},
    {3, "RADIAL", false, 2},
    {4, "OPENCV", true, 4},
    {5, "OPENCV_FISHEYE", true, 4, true},
    {6, "FULL_OPENCV", true, 8},
    {8, "SIMPLE_RADIAL_FISHEYE", false, 1, true},
    {9, "RADIAL_FISHEYE", false, 2, true},
};

template <class Matches>
const camera_model& find_model(const Matches& matches, const std::string& shown, const std::string& where) {
    const auto found = std::ranges::find_if(camera_models, matches);
    if (found != std::end(camera_models)) return *found;
    std::string supported;
    for (const camera_model& model : camera_models)
        supported += (supported.empty() ? "" : ", ") + std::string(model.name);
    throw error(where + ": the camera model " + shown + " is unknown; supported are " + supported);
}

}  // namespace

const camera_model& camera_model_with_id(int id, const std::string& where) {
    return find_model([&](const camera_model& model) { return model.id == id; },
                      "number " + std::to_string(id), where);
}

const camera_model& camera_model_named(std::string_view name, const std::string& where) {
    return find_model([&](const camera_model& model) { return model.name == name; },
                      sanitize_for_message(name), where);
}

}  // namespace gs
