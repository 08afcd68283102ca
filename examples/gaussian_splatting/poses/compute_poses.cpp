// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "compute_poses.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "../core/atomic_file_write.hpp"
#include "../core/enumerated.hpp"
#include "../core/error.hpp"
#include "../core/file_bytes.hpp"
#include "../readers/photo_files.hpp"
#include "child_process.hpp"
#include "colmap_run.hpp"
#include "readable_photos.hpp"
#include "video_frames.hpp"

namespace gs::poses {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* record_name = "photos.json";
constexpr const char* copies_name = "photos";  ///< folder of photos that COLMAP can read

void require_no_poses(const std::string& data) {
    for (const reader* one : all_readers())
        if (one->probe(data))
            throw error(data + " is a " + std::string(one->name) +
                        " scene, which has camera poses: leave out --poses auto");
}

fs::path photo_folder(const load_options& source) {
    const fs::path data = source.data, inside = data / source.images;
    if (fs::is_directory(inside)) return inside;
    if (images_option.is_set(source))
        throw error("the folder of photos " + inside.string() + " does not exist");
    if (!fs::exists(data)) throw error(source.data + " does not exist");
    if (!fs::is_directory(data))
        throw error("--poses auto: " + source.data + " is neither a folder of photos nor a video");
    return data;
}

photo_set find_photos(const load_options& source, const fs::path& output) {
    const fs::path folder = fs::canonical(photo_folder(source));
    if (fs::weakly_canonical(output) == folder)
        throw error("--output " + output.string() + " is the folder of the photos: choose another one");
    photo_set photos{folder, photo_names(folder, output)};
    if (photos.names.size() < fewest_photos)
        throw error("--poses auto needs at least " + std::to_string(fewest_photos) + " photos (" +
                    enumerated(image_endings(), " or ") + "), but " + folder.string() + " has " +
                    std::to_string(photos.names.size()));
    return photos;
}

void require_installed(const std::string& program, const std::string& title, const std::string& package) {
    if (is_installed(program)) return;
    throw error("--poses auto needs " + title + ", which is not installed: install the package " + package +
                " (apt-get install " + package + ")");
}

json file_record(const fs::path& file, const std::string& name) {
    return {{"name", name},
            {"bytes", fs::file_size(file)},
            {"modified", fs::last_write_time(file).time_since_epoch().count()}};
}

/// Describes the photos such that other photos have another description.
json record_of(const photo_set& photos) {
    json files = json::array();
    for (const std::string& name : photos.names) files.push_back(file_record(photos.folder / name, name));
    return {{"photos", files}};
}

/// Returns the record of the scene in a folder: null if it has none, empty if it is damaged.
json record_in(const fs::path& folder) {
    if (!fs::is_regular_file(folder / record_name)) return nullptr;
    json record = json::parse(file_bytes(folder / record_name), nullptr, false);
    return record.is_discarded() ? json::object() : record;
}

/// Links a name in a scene to a folder outside of it, if that exists.
void link_folder(const fs::path& link, const fs::path& folder) {
    std::error_code ignored;
    if (fs::read_symlink(link, ignored) == folder || !fs::is_directory(folder)) return;
    fs::remove(link);
    fs::create_directory_symlink(folder, link);
}

/// Links the photos, and masks beside them, where the reader looks for them.
void link_photos(const fs::path& scene, const photo_set& photos, const std::string& data) {
    if (!fs::exists(scene / copies_name)) link_folder(scene / "images", photos.folder);
    if (const fs::path masks = fs::path(data) / "masks"; fs::is_directory(masks))
        link_folder(scene / "masks", fs::canonical(masks));
}

/// A folder for a result that is not complete. It goes when the object goes, but its log stays if
/// the result is abandoned for any reason except an interruption.
class unfinished_result {
  public:
    explicit unfinished_result(const fs::path& result)
        : result_(result), path_(result.string() + ".part"), kept_log_(result.string() + ".log") {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    unfinished_result(const unfinished_result&) = delete;
    unfinished_result& operator=(const unfinished_result&) = delete;
    ~unfinished_result() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }

    const fs::path& path() const { return path_; }
    fs::path log() const { return path_ / "colmap.log"; }

    /// Keeps the log, and returns where it is.
    std::string keep_log() const {
        fs::rename(log(), kept_log_);
        return kept_log_.string();
    }
    void finish() const {
        fs::remove_all(result_);
        fs::rename(path_, result_);
        fs::remove(kept_log_);
    }

  private:
    fs::path result_, path_, kept_log_;
};

/// Computes a scene with the photos that `get_photos` returns.
template <class GetPhotos>
void compute_scene(const fs::path& scene, const json& record, const listener& user,
                   const GetPhotos& get_photos) {
    const unfinished_result part(scene);
    try {
        stage_runner runner(part.log(), user);
        const photo_set photos = get_photos(part.path(), runner);
        user.say("computing the camera poses of " + std::to_string(photos.names.size()) +
                 " photos with COLMAP, whose output is in " + part.log().string());
        run_colmap(photos, part.path(), runner, user);
        atomic_file_write(part.path() / record_name,
                          [&](std::ostream& out) { out << record.dump(1) << '\n'; });
    } catch (const interrupted&) {
        throw;
    } catch (const error& failed) {
        throw error(failed.what() + std::string("; see ") + part.keep_log());
    }
    part.finish();
}

/// Returns whether the scene comes from what `record` describes. Throws `error` for a folder that
/// `compute_scene` has not written, because it would be lost.
bool is_reusable(const fs::path& scene, const json& record, const listener& user) {
    if (!fs::exists(scene)) return false;
    const json earlier = record_in(scene);
    if (earlier.is_null() && !fs::is_empty(scene))
        throw error(scene.string() +
                    " was not written by --poses auto: rename it, or choose another --output");
    if (earlier != record) return false;
    user.say("using the camera poses in " + scene.string() + " again, because the photos are the same");
    return true;
}

void compute_from_photos(const load_options& source, const fs::path& output, const fs::path& scene,
                         const listener& user) {
    const photo_set photos = find_photos(source, output);
    const json record = record_of(photos);
    if (!is_reusable(scene, record, user)) {
        require_installed("colmap", "COLMAP", "colmap");
        compute_scene(scene, record, user, [&](const fs::path& part, stage_runner&) {
            if (is_readable_by_colmap(photos)) return photos;
            fs::create_directory_symlink(copies_name, part / "images");
            return make_readable(photos, part / copies_name, user);
        });
    }
    link_photos(scene, photos, source.data);
}

void compute_from_video(const fs::path& video, int frames, const fs::path& scene, const listener& user) {
    json record = {{"video", file_record(video, video.filename().string())}, {"frames", frames}};
    if (is_reusable(scene, record, user)) return;
    require_installed("colmap", "COLMAP", "colmap");
    require_installed("ffmpeg", "ffmpeg", "ffmpeg");
    require_installed("ffprobe", "ffprobe", "ffmpeg");
    compute_scene(scene, record, user, [&](const fs::path& part, stage_runner& runner) {
        extract_frames(fs::canonical(video), frames, part / "frames", runner, user);
        fs::create_directory_symlink("frames", part / "images");
        return photo_set{part / "frames", photo_names(part / "frames"), true};
    });
}

}  // namespace

load_options compute_poses(const load_options& source, const fs::path& output,
                           std::optional<int> video_frames, const listener& user) {
    require_no_poses(source.data);
    const fs::path scene = output / "colmap";
    if (is_video_file(source.data)) {
        if (images_option.is_set(source)) throw error("--images does not apply to a video");
        compute_from_video(source.data, video_frames.value_or(default_video_frames), scene, user);
    } else {
        if (video_frames) throw error("--video-frames does not apply to photos, only to a video");
        compute_from_photos(source, output, scene, user);
    }
    load_options computed = source;
    computed.data = scene.string();
    computed.images = load_options().images;
    return computed;
}

}  // namespace gs::poses
