// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "load_scene.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "../core/byte_size.hpp"
#include "../core/error.hpp"
#include "../photos/packed_photo.hpp"
#include "../photos/photo_plan.hpp"
#include "load_views.hpp"
#include "photo_files.hpp"
#include "scene_archive.hpp"

namespace gs {
namespace {

using reader_table = std::span<const reader* const>;

const reader& reader_of(const std::string& data, reader_table readers) {
    for (const reader* one : readers)
        if (one->probe(data)) return *one;
    if (const std::string message = missing_poses_message(data); !message.empty()) throw error(message);
    throw error(data + (std::filesystem::exists(data) ? " is not a scene" : " does not exist") +
                "; a scene is " + accepted_scenes(readers));
}

bool uses(const reader& one, const reader_option& option) {
    return std::ranges::find(one.options, option.name, &reader_option::name) != one.options.end();
}

/// Throws `error` for options that the chosen reader does not use. An option without effect is a
/// mistake of the user, so it is not ignored.
void refuse_foreign_options(const load_options& options, const reader& chosen, reader_table readers) {
    for (const reader* other : readers)
        for (const reader_option& option : other->options)
            if (option.is_set(options) && !uses(chosen, option))
                throw error(std::string(option.name) + " does not apply to " + std::string(chosen.name) +
                            " scenes, only to " + readers_with(option.name, readers) + " scenes");
}

scene_description describe(const load_options& options, const log_function& log, reader_table readers) {
    try {
        const reader& chosen = reader_of(options.data, readers);
        refuse_foreign_options(options, chosen, readers);
        return chosen.read(options, log);
    } catch (const std::filesystem::filesystem_error& problem) {
        throw error("cannot read " + problem.path1().string() + ": " + problem.code().message());
    }
}

std::vector<view> views_of(std::vector<image_record>& images, const load_options& options,
                           const log_function& log) {
    std::vector<image_record> files;
    std::ranges::copy_if(images, std::back_inserter(files),
                         [](const image_record& one) { return !one.has_pixels(); });
    std::vector<view> loaded = load_views(files, options, log);
    auto next = loaded.begin();
    std::vector<view> views;
    views.reserve(images.size());
    for (image_record& one : images)
        if (one.has_pixels())
            views.push_back({one.name, one.camera, std::move(one.pixels), std::move(one.depth_pixels)});
        else
            views.push_back(std::move(*next++));
    return views;
}

void require_views(const scene& loaded, const load_options& options) {
    const std::string split = " (" + std::to_string(loaded.train.size()) + " for training, " +
                              std::to_string(loaded.test.size()) + " held out)";
    if (loaded.train.empty()) throw error(options.data + " has no training views" + split);
    if (options.eval && loaded.test.empty()) throw error(options.data + " has no test views" + split);
}

bool any_has_alpha(const std::vector<view>& views) {
    return std::ranges::any_of(views, [](const view& one) { return one.pixels.has_alpha; });
}

/// Throws `error` if photos that have no files exceed the limit of memory.
void require_memory(const std::vector<view>& views, const load_options& options) {
    std::uint64_t bytes = 0;
    for (const view& v : views)
        if (!v.is_streamed()) bytes += photos::packed_bytes(v.camera, v.depths.is_there());
    if (bytes > options.most_photo_bytes)
        throw error("the photos of " + options.data + " have " + size_in_bytes(bytes) +
                    " and no files, so they cannot be loaded in parts: lower --resolution, or raise "
                    "--photo-memory");
}

scene load_opened(const load_options& options, const log_function& say, reader_table readers) {
    scene_description described = describe(options, say, readers);
    std::vector<view> views = views_of(described.images, options, say);
    require_memory(views, options);
    scene result;
    result.points = std::move(described.points);
    result.object_centered = described.object_centered;
    result.rendered = described.rendered;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const bool held_out = options.eval && described.images[i].held_out;
        (held_out ? result.test : result.train).push_back(std::move(views[i]));
    }
    result.has_alpha = any_has_alpha(result.train) || any_has_alpha(result.test);
    require_views(result, options);
    return result;
}

scene load_archive(const load_options& options, const log_function& say, reader_table readers) {
    const extracted_archive archive(options.data);
    load_options opened = options;
    opened.data = archive.folder().string();
    // An archive may have one folder around the files of the scene.
    const auto accepts = [&](const reader* one) { return one->probe(opened.data); };
    if (std::ranges::none_of(readers, accepts)) opened.data = archive.only_folder().string();
    try {
        scene loaded = load_opened(
            opened, [&](const std::string& line) { say(archive.with_archive_name(line)); }, readers);
        if (photos::any_is_streamed(loaded.train, loaded.test))
            throw error("the photos of " + options.data +
                        " exceed the memory for photos: unpack the archive, so that training can read "
                        "its files again, or raise --photo-memory");
        return loaded;
    } catch (const error& problem) {
        throw error(archive.with_archive_name(problem.what()));
    }
}

}  // namespace

scene load_scene(const load_options& options, const log_function& log, reader_table readers) {
    if (options.resolution < 1)
        throw error("the resolution must be at least 1, not " + std::to_string(options.resolution));
    const log_function say = log ? log : [](const std::string&) {};
    return is_archive(options.data) ? load_archive(options, say, readers)
                                    : load_opened(options, say, readers);
}

}  // namespace gs
