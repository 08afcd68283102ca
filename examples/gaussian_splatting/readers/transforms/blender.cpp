// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "blender.hpp"

#include <algorithm>
#include <iterator>

#include "transforms_images.hpp"

namespace gs {
namespace {

constexpr const char* training_file = "transforms_train.json";

std::vector<image_record> test_records(const std::filesystem::path& data, const load_options& options) {
    for (const char* name : {"transforms_test.json", "transforms_val.json"}) {
        if (!std::filesystem::exists(data / name)) continue;
        auto records = image_records(data, read_transforms(data / name), options);
        for (image_record& one : records) one.held_out = true;
        return records;
    }
    return {};
}

scene_description describe_blender(const load_options& options, const log_function&) {
    const std::filesystem::path data = options.data;
    const transforms training = read_transforms(data / training_file);
    scene_description result;
    result.object_centered = result.rendered = true;
    result.images = image_records(data, training, options);
    std::ranges::move(test_records(data, options), std::back_inserter(result.images));
    result.points = points_of(data, training);
    return result;
}

}  // namespace

constinit const reader blender_reader{
    "Blender", "a Blender folder with transforms_train.json",
    [](const std::string& data) {
        return std::filesystem::exists(std::filesystem::path(data) / training_file);
    },
    describe_blender};

}  // namespace gs
