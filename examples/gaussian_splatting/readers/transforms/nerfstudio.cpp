// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "nerfstudio.hpp"

#include "../validation.hpp"
#include "transforms_images.hpp"

namespace gs {
namespace {

constexpr const char* transforms_file = "transforms.json";

scene_description describe_nerfstudio(const load_options& options, const log_function& log) {
    const std::filesystem::path data = options.data;
    const transforms all = read_transforms(data / transforms_file);
    scene_description result;
    result.images = image_records(data, all, options);
    hold_out_views(result.images, options);
    result.points = points_of(data, all);
    if (result.points.empty()) log("the nerfstudio scene has no points");
    return result;
}

constexpr reader_option used_options[] = {test_every_option};

}  // namespace

constinit const reader nerfstudio_reader{
    "nerfstudio", "a nerfstudio folder with transforms.json",
    [](const std::string& data) {
        return std::filesystem::exists(std::filesystem::path(data) / transforms_file);
    },
    describe_nerfstudio, used_options};

}  // namespace gs
