// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "fit_to_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "../core/error.hpp"
#include "size_text.hpp"

namespace gs {
namespace {

constexpr double ratio_tolerance = 0.01;  // of the aspect ratio, because smaller copies have rounded sizes

enum class fit { neither, stored, upright, both };

[[noreturn]] void refuse_size(const image_record& record, const image_header& file) {
    std::string sizes = size_text(file.width, file.height) + " pixels";
    if (file.turn.swaps_sides)
        sizes += " (" + size_text(file.height, file.width) + " after the rotation in its EXIF data)";
    throw error("the image " + record.file.string() + " is of the wrong size: it has " + sizes +
                ", its camera " + size_text(record.camera.width, record.camera.height) +
                "; use the photo from which the camera was computed, or a smaller copy of it");
}

/// Returns by how much the shape of an image differs from that of its camera; 0 if not at all.
double difference(const camera& of, int width, int height) {
    return std::abs(
        std::log((static_cast<double>(width) * of.height) / (static_cast<double>(height) * of.width)));
}

fit fit_of(const image_record& record, const image_header& file) {
    const double stored = difference(record.camera, file.width, file.height);
    const double upright =
        file.turn.swaps_sides ? difference(record.camera, file.height, file.width) : stored;
    if (std::min(stored, upright) > std::log1p(ratio_tolerance)) return fit::neither;
    if (std::abs(stored - upright) < 1e-9) return fit::both;
    return stored < upright ? fit::stored : fit::upright;
}

/// Returns which photos are to be turned upright.
std::vector<bool> choose_turned(const std::vector<image_record>& records,
                                const std::vector<image_header>& headers) {
    std::vector<fit> fits;
    std::ptrdiff_t votes = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        fits.push_back(fit_of(records[i], headers[i]));
        if (fits[i] == fit::neither) refuse_size(records[i], headers[i]);
        if (fits[i] != fit::both) votes += fits[i] == fit::upright ? 1 : -1;
    }
    std::vector<bool> turned;
    for (std::size_t i = 0; i < records.size(); ++i)
        turned.push_back(headers[i].turn != orientation() &&
                         (fits[i] == fit::upright || (fits[i] == fit::both && votes > 0)));
    return turned;
}

/// Throws `error` for photos of a wrong size. Smaller copies all have the same scale, so a photo
/// with another scale than most photos of the same recorded size is a wrong file.
void require_one_scale(const std::vector<image_record>& records, const std::vector<image_header>& headers,
                       const std::vector<fitted_photo>& fitted) {
    const auto scale = [&](std::size_t i) {
        return static_cast<double>(fitted[i].taken_with.width) / records[i].camera.width;
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
        if (std::abs(scale(i) / values[values.size() / 2] - 1) > ratio_tolerance)
            refuse_size(records[i], headers[i]);
    }
}

void report_resized(const std::vector<image_record>& records, const std::vector<fitted_photo>& fitted,
                    const log_function& log) {
    std::size_t resized = 0, first = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const camera &before = records[i].camera, &after = fitted[i].taken_with;
        if (before.width == after.width && before.height == after.height) continue;
        if (resized++ == 0) first = i;
    }
    if (resized == 0) return;
    const camera &before = records[first].camera, &after = fitted[first].taken_with;
    log(count_text(resized, "photo") + " differ in size from their cameras, whose intrinsics were scaled (" +
        records[first].name + ": " + size_text(before.width, before.height) + " to " +
        size_text(after.width, after.height) + ")");
}

void report_turned(const std::vector<image_record>& records, const std::vector<bool>& turned,
                   const log_function& log) {
    const auto count = static_cast<std::size_t>(std::ranges::count(turned, true));
    if (count == 0) return;
    const auto first = static_cast<std::size_t>(std::ranges::find(turned, true) - turned.begin());
    log(count_text(count, "photo") + " turned upright, as the EXIF data of " + records[first].name +
        (count == 1 ? " specifies" : " and others specify"));
}

}  // namespace

std::vector<fitted_photo> fit_to_files(const std::vector<image_record>& records, const log_function& log) {
    std::vector<image_header> headers;
    for (const image_record& record : records) headers.push_back(read_image_header(record.file));
    const std::vector<bool> turned = choose_turned(records, headers);
    std::vector<fitted_photo> fitted;
    for (std::size_t i = 0; i < records.size(); ++i) {
        image_header used = headers[i];
        if (!turned[i]) used.turn = {};
        if (used.turn.swaps_sides) std::swap(used.width, used.height);
        fitted.push_back({records[i].camera.resized(used.width, used.height), used.turn});
    }
    require_one_scale(records, headers, fitted);
    report_turned(records, turned, log);
    report_resized(records, fitted, log);
    return fitted;
}

}  // namespace gs
