// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "load_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include "../core/error.hpp"
#include "../core/parallel.hpp"
#include "../photos/packed_photo.hpp"
#include "../scene/downsample.hpp"
#include "fit_to_files.hpp"
#include "photo_source.hpp"
#include "size_text.hpp"

namespace gs {
namespace {

/// Finds pinhole cameras for cameras with lens distortion, and remembers them.
class undistorted_cameras {
  public:
    camera pinhole_of(const camera& fitted, const image_record& record) {
        const lens& d = record.distortion;
        if (d.is_none()) return fitted;
        const key same(fitted.width, fitted.height, fitted.fx, fitted.fy, fitted.cx, fitted.cy, d.k1, d.k2,
                       d.p1, d.p2, d.k3);
        auto found = known_.find(same);
        if (found == known_.end()) {
            const auto pinhole = undistorted_camera(fitted, d);
            if (!pinhole)
                throw error("the camera of " + record.file.string() +
                            " distorts too strongly to be turned into a pinhole camera");
            found = known_.emplace(same, *pinhole).first;
            models_.insert(record.camera_model);
        }
        camera result = fitted;  // with its own pose
        result.fx = found->second.fx;
        result.fy = found->second.fy;
        return result;
    }

    void report(const log_function& log) const {
        if (known_.empty()) return;
        std::string names;
        for (const std::string& model : models_) names += (names.empty() ? "" : ", ") + model;
        log(count_text(known_.size(), "camera") + " (" + names +
            ") with lens distortion: the photos were resampled to pinhole cameras");
    }

  private:
    using key = std::tuple<int, int, double, double, double, double, double, double, double, double, double>;
    std::map<key, camera> known_;  ///< most photos share a camera; finding its zoom is slow
    std::set<std::string> models_;
};

std::vector<camera> undistort_cameras(const std::vector<image_record>& records,
                                      const std::vector<fitted_photo>& fitted, const log_function& log) {
    undistorted_cameras known;
    std::vector<camera> pinholes;
    pinholes.reserve(fitted.size());
    for (std::size_t i = 0; i < fitted.size(); ++i)
        pinholes.push_back(known.pinhole_of(fitted[i].taken_with, records[i]));
    known.report(log);
    return pinholes;
}

/// Throws `error` for a fisheye lens whose model ends inside the photo on all sides, because its
/// parameters are wrong. Corners may lie beyond the end.
void require_wide_lenses(const std::vector<image_record>& records, const std::vector<fitted_photo>& fitted) {
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        const camera& c = fitted[i].taken_with;
        if (!c.fisheye) continue;
        const double to_edge =
            std::min(std::max(c.cx, c.width - c.cx) / c.fx, std::max(c.cy, c.height - c.cy) / c.fy);
        if (c.fisheye->radius(c.fisheye->end()) < to_edge)
            throw error(
                "the fisheye lens of " + records[i].file.string() + " folds the photo over inside of it, " +
                std::to_string(static_cast<int>(57.29578 * c.fisheye->end())) + " degrees from the axis");
    }
}

camera at_resolution(const camera& full, int resolution) {
    if (divides_size(resolution)) return downsampled(full, resolution);
    const int longer = std::max(full.width, full.height);
    if (resolution >= longer) return full;
    const auto scaled = [&](int side) {
        const double ratio = static_cast<double>(resolution) / longer;
        return std::max(1, static_cast<int>(std::lround(ratio * side)));
    };
    return full.resized(scaled(full.width), scaled(full.height));
}

std::vector<camera> scale_to_resolution(const std::vector<camera>& full,
                                        const std::vector<image_record>& records, int resolution,
                                        const log_function& log) {
    std::vector<camera> scaled;
    scaled.reserve(full.size());
    std::size_t resized = 0, kept = 0, first = 0;
    for (std::size_t i = 0; i < full.size(); ++i) {
        scaled.push_back(at_resolution(full[i], resolution));
        if (!divides_size(resolution) && resolution > std::max(full[i].width, full[i].height)) ++kept;
        if (scaled[i].width == full[i].width && scaled[i].height == full[i].height) continue;
        if (resized++ == 0) first = i;
    }
    if (resized > 0)
        log(count_text(resized, "photo") + " resized (" + records[first].name + ": " +
            size_text(full[first].width, full[first].height) + " to " +
            size_text(scaled[first].width, scaled[first].height) + ")");
    if (kept > 0)
        log(count_text(kept, "photo") + " left as they are: resolution " + std::to_string(resolution) +
            " is more than their longer side");
    return scaled;
}

void report_count(const std::vector<image_record>& records, std::filesystem::path image_record::*file,
                  const char* one, const char* several, const log_function& log) {
    const auto count = std::ranges::count_if(records, [&](const auto& r) { return !(r.*file).empty(); });
    if (count > 0)
        log(count_text(static_cast<std::size_t>(count), "photo") + " of " + std::to_string(records.size()) +
            (count == 1 ? one : several));
}

}  // namespace

std::vector<view> load_views(const std::vector<image_record>& records, const load_options& options,
                             const log_function& log) {
    const std::vector<fitted_photo> fitted = fit_to_files(records, log);
    require_wide_lenses(records, fitted);
    const std::vector<camera> pinholes = undistort_cameras(records, fitted, log);
    const std::vector<camera> scaled = scale_to_resolution(pinholes, records, options.resolution, log);
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < records.size(); ++i)
        bytes += photos::packed_bytes(scaled[i], !records[i].depth.empty());
    const bool streams = bytes > options.most_photo_bytes;
    std::vector<view> views(records.size());
    for_each_in_parallel(records.size(), [&](std::size_t i) {
        photo_source source{records[i], fitted[i], pinholes[i], scaled[i]};
        views[i] = streams ? streamed_view(std::make_shared<const photo_source>(std::move(source)))
                           : resident_view(source);
        views[i].rig_frame = records[i].rig_frame;
        views[i].removed_distortion = records[i].distortion;
        views[i].camera_of_file = fitted[i].taken_with;
    });
    report_count(records, &image_record::mask, " has a mask", " have masks", log);
    report_count(records, &image_record::depth, " has a depth map", " have depth maps", log);
    return views;
}

}  // namespace gs
