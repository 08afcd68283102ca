// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "load_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "../core/error.hpp"
#include "../core/parallel.hpp"
#include "../image/mask.hpp"

namespace gs {
namespace {

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

std::string count_text(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

camera at_size(camera taken_with, int width, int height) {
    const double x = static_cast<double>(width) / taken_with.width;
    const double y = static_cast<double>(height) / taken_with.height;
    taken_with.width = width;
    taken_with.height = height;
    taken_with.fx *= x;
    taken_with.cx *= x;
    taken_with.fy *= y;
    taken_with.cy *= y;
    return taken_with;
}

[[noreturn]] void refuse_size(const image_record& records, int width, int height) {
    throw error("the image " + records.file.string() + " is of the wrong size: it has " +
                size_text(width, height) + " pixels, its camera " +
                size_text(records.camera.width, records.camera.height));
}

/// Photos are often replaced by smaller copies of themselves (`images_4`): then the camera follows.
camera fitted_to_photo(const image_record& records) {
    int width = 0, height = 0;
    read_image_size(records.file, width, height);
    const camera& was = records.camera;
    const double x = static_cast<double>(width) / was.width, y = static_cast<double>(height) / was.height;
    if (std::abs(x / y - 1) > 0.01) refuse_size(records, width, height);
    return at_size(was, width, height);
}

/// But all copies are made alike: a photo that is scaled otherwise than most of its camera's size is a wrong
/// one.
void require_one_scale(const std::vector<image_record>& records, const std::vector<camera>& fitted) {
    const auto scale = [&](std::size_t i) {
        return static_cast<double>(fitted[i].width) / records[i].camera.width;
    };
    std::map<std::pair<int, int>, std::vector<double>> scales;
    const auto size = [&](std::size_t i) {
        return std::pair(records[i].camera.width, records[i].camera.height);
    };
    for (std::size_t i = 0; i < records.size(); ++i) scales[size(i)].push_back(scale(i));
    for (auto& [of, values] : scales)
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                         values.end());
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& values = scales[size(i)];
        if (std::abs(scale(i) / values[values.size() / 2] - 1) > 0.01)
            refuse_size(records[i], fitted[i].width, fitted[i].height);
    }
}

std::vector<camera> fit_to_photos(const std::vector<image_record>& records, const log_function& log) {
    std::vector<camera> fitted;
    fitted.reserve(records.size());
    std::size_t others = 0, first = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        fitted.push_back(fitted_to_photo(records[i]));
        const camera &was = records[i].camera, &is = fitted.back();
        if (was.width == is.width && was.height == is.height) continue;
        if (others++ == 0) first = i;
    }
    require_one_scale(records, fitted);
    if (others > 0)
        log(count_text(others, "photo") +
            " differ in size from their cameras, whose intrinsics were scaled (" + records[first].name +
            ": " + size_text(records[first].camera.width, records[first].camera.height) + " to " +
            size_text(fitted[first].width, fitted[first].height) + ")");
    return fitted;
}

std::vector<camera> straighten(const std::vector<image_record>& records, const std::vector<camera>& fitted,
                               const log_function& log) {
    using key = std::tuple<int, int, double, double, double, double, double, double, double, double>;
    std::map<key, camera> known;  // views mostly share a camera, and finding its zoom takes a while
    std::set<std::string> models;
    std::vector<camera> straight = fitted;
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        const lens& bent = records[i].distortion;
        if (bent.is_straight()) continue;
        const camera& was = fitted[i];
        const key same(was.width, was.height, was.fx, was.fy, was.cx, was.cy, bent.k1, bent.k2, bent.p1,
                       bent.p2);
        auto found = known.find(same);
        if (found == known.end()) {
            const auto pinhole = straightened(was, bent);
            if (!pinhole)
                throw error("the camera of " + records[i].file.string() +
                            " distorts too strongly to be turned into a pinhole camera");
            found = known.emplace(same, *pinhole).first;
            models.insert(records[i].camera_model);
        }
        straight[i].fx = found->second.fx;
        straight[i].fy = found->second.fy;
    }
    if (!known.empty()) {
        std::string names;
        for (const std::string& model : models) names += (names.empty() ? "" : ", ") + model;
        log(count_text(known.size(), "camera") + " (" + names +
            ") with lens distortion: the photos were resampled to pinhole cameras");
    }
    return straight;
}

/// A lens whose model ends before the photo does anywhere is a wrong one; corners may lie beyond its end.
void require_wide_lenses(const std::vector<image_record>& records, const std::vector<camera>& fitted) {
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        const camera& c = fitted[i];
        if (!c.fisheye) continue;
        const double to_edge =
            std::min(std::max(c.cx, c.width - c.cx) / c.fx, std::max(c.cy, c.height - c.cy) / c.fy);
        if (c.fisheye->reach(c.fisheye->end()) < to_edge)
            throw error(
                "the fisheye lens of " + records[i].file.string() + " folds the photo over inside of it, " +
                std::to_string(static_cast<int>(57.29578 * c.fisheye->end())) + " degrees from the axis");
    }
}

int divided(int side, int divisor) { return std::max(1, (2 * side + divisor) / (2 * divisor)); }

camera at_resolution(const camera& full, int resolution) {
    if (divides_size(resolution))
        return at_size(full, divided(full.width, resolution), divided(full.height, resolution));
    const int longer = std::max(full.width, full.height);
    if (resolution >= longer) return full;
    const auto scaled = [&](int side) {
        const double ratio = static_cast<double>(resolution) / longer;
        return std::max(1, static_cast<int>(std::lround(ratio * side)));
    };
    return at_size(full, scaled(full.width), scaled(full.height));
}

std::vector<camera> scale_to_resolution(const std::vector<camera>& full,
                                        const std::vector<image_record>& records, int resolution,
                                        const log_function& log) {
    std::vector<camera> scaled;
    scaled.reserve(full.size());
    std::size_t shrunk = 0, kept = 0, first = 0;
    for (std::size_t i = 0; i < full.size(); ++i) {
        scaled.push_back(at_resolution(full[i], resolution));
        if (!divides_size(resolution) && resolution > std::max(full[i].width, full[i].height)) ++kept;
        if (scaled[i].width == full[i].width && scaled[i].height == full[i].height) continue;
        if (shrunk++ == 0) first = i;
    }
    if (shrunk > 0)
        log(count_text(shrunk, "photo") + " resized (" + records[first].name + ": " +
            size_text(full[first].width, full[first].height) + " to " +
            size_text(scaled[first].width, scaled[first].height) + ")");
    if (kept > 0)
        log(count_text(kept, "photo") + " left as they are: resolution " + std::to_string(resolution) +
            " is more than their longer side");
    return scaled;
}

}  // namespace

view shrunk(const view& full, int divisor) {
    const camera& c = full.camera;
    const camera small = at_size(c, divided(c.width, divisor), divided(c.height, divisor));
    return {full.name, small, shrink(full.pixels, small.width, small.height),
            resized(full.depths, small.width, small.height)};
}

std::vector<view> load_views(const std::vector<image_record>& records, int resolution,
                             const log_function& log) {
    const std::vector<camera> fitted = fit_to_photos(records, log);
    require_wide_lenses(records, fitted);
    const std::vector<camera> straight = straighten(records, fitted, log);
    const std::vector<camera> scaled = scale_to_resolution(straight, records, resolution, log);
    std::vector<view> views(records.size());
    for_each_in_parallel(records.size(), [&](std::size_t i) {
        const image_record& record = records[i];
        const lens& distortion = record.distortion;
        image photo = read_image(record.file);
        image counts = record.mask.empty() ? image() : read_mask(record.mask, photo);
        depth_map depths =
            record.depth.empty() ? depth_map() : read_depth_map(record.depth, photo.width, photo.height);
        if (!distortion.is_straight()) {
            photo = undistort(photo, fitted[i], distortion, straight[i]);
            if (!record.mask.empty()) counts = undistort(counts, fitted[i], distortion, straight[i]);
            if (depths.is_there()) depths = undistort(depths, fitted[i], distortion, straight[i]);
        }
        apply_mask(counts, photo);  // before shrinking, so that what it leaves out is in no average
        forget_left_out(photo, depths);
        photo = shrink(photo, scaled[i].width, scaled[i].height);
        if (photo.leaves_all_out())
            throw error("the mask " + record.mask.string() + " leaves nothing of its photo");
        views[i] = {record.name, scaled[i], std::move(photo),
                    resized(depths, scaled[i].width, scaled[i].height)};
    });
    const auto say = [&](std::filesystem::path image_record::*file, const char* one, const char* several) {
        const auto count = std::ranges::count_if(records, [&](const auto& r) { return !(r.*file).empty(); });
        if (count > 0)
            log(count_text(static_cast<std::size_t>(count), "photo") + " of " +
                std::to_string(records.size()) + (count == 1 ? one : several));
    };
    say(&image_record::mask, " has a mask", " have masks");
    say(&image_record::depth, " has a depth map", " have depth maps");
    return views;
}

}  // namespace gs
