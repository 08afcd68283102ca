// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "photo_source.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "../core/error.hpp"
#include "../image/jpeg_planes.hpp"
#include "../image/mask.hpp"

namespace gs {
namespace {

namespace fs = std::filesystem;

void read_photo(const fs::path& file, const orientation& turn, image& photo) {
    read_image(file, photo);
    if (turn != orientation()) photo = turned_upright(photo, turn);
}

/// The size and the time of a file, which reveal that it has been replaced.
struct file_stamp {
    fs::path file;
    std::uintmax_t size = 0;
    fs::file_time_type time{};

    explicit file_stamp(const fs::path& of)
        : file(of), size(fs::file_size(of)), time(fs::last_write_time(of)) {}

    void check() const {
        std::error_code missing;
        const std::uintmax_t size_now = fs::file_size(file, missing);
        const fs::file_time_type time_now = missing ? time : fs::last_write_time(file, missing);
        if (missing)
            throw error("cannot read " + file.string() + " again (" + missing.message() +
                        "): training decodes photos while it runs; restore the file and continue with "
                        "--resume");
        if (size_now != size || time_now != time)
            throw error(file.string() +
                        " has changed since training loaded it: restore the file and continue with "
                        "--resume, or train from the beginning");
    }
};

std::vector<file_stamp> stamps_of(const image_record& record) {
    std::vector<file_stamp> stamps;
    for (const fs::path* file : {&record.file, &record.mask, &record.depth})
        if (!file->empty()) stamps.emplace_back(*file);
    return stamps;
}

std::size_t pixels_of(const camera& c) {
    return static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
}

/// Returns the largest size of the images that `photo_source::load` holds at once.
std::size_t load_bytes(const photo_source& source) {
    const image_record& record = source.record;
    const bool has_copy = !record.distortion.is_none() || source.fitted.turn != orientation();
    const std::size_t full = pixels_of(source.fitted.taken_with), wanted = pixels_of(source.scaled);
    const std::size_t bytes =
        4 + (has_copy ? 4 : 0) + (record.mask.empty() ? 0 : 4) + (record.depth.empty() ? 0 : 2);
    return bytes * full + (wanted < full ? 4 * wanted : 0);
}

/// Returns whether `photo_source::load` only reads the photo.
bool is_as_stored(const photo_source& source) {
    const image_record& record = source.record;
    return record.distortion.is_none() && source.fitted.turn == orientation() && record.mask.empty() &&
           record.depth.empty() && record.masked_border == 0 &&
           pixels_of(source.scaled) == pixels_of(source.fitted.taken_with);
}

}  // namespace

photo photo_source::load() const {
    photo result;
    load(result);
    return result;
}

void photo_source::load(gs::photo& result) const {
    const lens& distortion = record.distortion;
    image& photo = result.pixels;
    read_photo(record.file, fitted.turn, photo);
    image mask = record.mask.empty() ? image() : read_mask(record.mask, photo);
    depth_map depths = record.depth.empty()
                           ? depth_map()
                           : read_depth_map(record.depth, photo.width, photo.height, record.depth_holds);
    if (!distortion.is_none()) {
        photo = undistort(photo, fitted.taken_with, distortion, pinhole);
        if (!record.mask.empty()) mask = undistort(mask, fitted.taken_with, distortion, pinhole);
        if (depths.is_there()) depths = undistort(depths, fitted.taken_with, distortion, pinhole);
    }
    apply_mask(mask, photo);  // before downsampling, to keep masked pixels out of averages
    mask_border(record.masked_border * fitted.taken_with.width / record.camera.width, photo);
    clear_masked_depths(photo, depths);
    if (scaled.width != photo.width || scaled.height != photo.height)
        photo = downsample(photo, scaled.width, scaled.height);
    if (photo.is_all_masked())
        throw error(record.mask.empty()
                        ? record.file.string() + " is no larger than its masked border"
                        : "the mask " + record.mask.string() + " leaves nothing of its photo");
    result.depths = resized(depths, scaled.width, scaled.height);
}

view resident_view(const photo_source& source) {
    photo loaded = source.load();
    return {source.record.name, source.scaled, std::move(loaded.pixels), std::move(loaded.depths)};
}

view streamed_view(std::shared_ptr<const photo_source> source) {
    std::vector<file_stamp> stamps = stamps_of(source->record);
    view result = resident_view(*source);
    // Assigning {} would keep the memory.
    result.pixels.rgba = std::vector<std::uint8_t>();
    result.depths.values = std::vector<std::uint16_t>();
    result.decode_bytes = load_bytes(*source);
    if (is_as_stored(*source)) result.plane_bytes = jpeg_plane_bytes(source->record.file);
    if (result.plane_bytes > 0)
        result.read_planes = [source, stamps](jpeg_planes& into) {
            for (const file_stamp& stamp : stamps) stamp.check();
            read_jpeg_planes(source->record.file, into);
        };
    result.decode = [source = std::move(source), stamps = std::move(stamps)](photo& into) {
        for (const file_stamp& stamp : stamps) stamp.check();
        source->load(into);
    };
    return result;
}

}  // namespace gs
