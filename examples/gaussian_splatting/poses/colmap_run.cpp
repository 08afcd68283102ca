// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "colmap_run.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "../core/atomic_file_write.hpp"
#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"
#include "../image/image.hpp"
#include "../readers/colmap/colmap.hpp"

namespace gs::poses {
namespace {

namespace fs = std::filesystem;

// COLMAP matches on the CPU here. The time for a pair grows with the square of the features, and
// the number of pairs with the square of the photos.
constexpr const char* most_features = "4096";
constexpr std::size_t most_exhaustive = 150;
constexpr std::size_t block_size = 20;         ///< photos per block of exhaustive matching
constexpr std::size_t pairs_per_block = 1225;  ///< of COLMAP, for the progress

/// Returns the part of a line that begins with `words`, because newer versions of COLMAP begin
/// lines with the time and the source.
const char* part_from(const std::string& line, const char* words) {
    const char* part = std::strstr(line.c_str(), words);
    return part ? part : "";
}

/// A line like "Matching block [2/5, 1/5]" or "Matching block [2/5]" ends when the block is
/// matched.
int blocks_done(const std::string& line) {
    int i = 0, n = 0, j = 0, m = 0;
    const char* part = part_from(line, "Matching block [");
    const int found = std::sscanf(part, "Matching block [%9d/%9d, %9d/%9d]", &i, &n, &j, &m);
    return found == 4 ? (i - 1) * m + j : found == 2 ? i : -1;
}

/// A line like "Registering image #17 (3)" has the number of photos with a pose.
int images_registered(const std::string& line) {
    int id = 0, count = 0;
    const char* part = part_from(line, "Registering image #");
    return std::sscanf(part, "Registering image #%9d (%9d)", &id, &count) == 2 ? count : -1;
}

/// OPENCV describes most lenses well, but a few photos do not determine its eight parameters.
const char* camera_model_for(std::size_t photos) { return photos < 10 ? "SIMPLE_RADIAL" : "OPENCV"; }

/// Extracts features of each group in a run of its own, because each run adds one camera to the
/// database.
void extract_features(const photo_set& photos, const fs::path& result, stage_runner& runner,
                      const listener& user) {
    const stopwatch watch;
    const auto groups = groups_of_equal_size(photos);
    const fs::path list = result / "photos.txt";
    int processed = 0;
    for (const std::vector<std::string>& group : groups) {
        atomic_file_write(list, [&](std::ostream& out) {
            for (const std::string& name : group) out << name << '\n';
        });
        runner.require({.name = "features",
                        .program = "colmap",
                        .arguments = {"feature_extractor", "--database_path", result / "database.db",
                                      "--image_path", photos.folder, "--image_list_path", list,
                                      "--ImageReader.single_camera", "1", "--ImageReader.camera_model",
                                      camera_model_for(group.size()), "--SiftExtraction.max_num_features",
                                      most_features, "--SiftExtraction.use_gpu", "0"},
                        .total = static_cast<int>(photos.names.size()),
                        .parts_done = [&](const std::string& line) {
                            return *part_from(line, "Processed file [") != 0 ? ++processed : -1;
                        }});
    }
    fs::remove(list);
    user.say("features of " + std::to_string(processed) + " photos of " + std::to_string(groups.size()) +
             (groups.size() == 1 ? " camera: " : " cameras (one for each size of photos): ") + watch.text());
}

stage exhaustive_stage(std::size_t photos) {
    const auto blocks = static_cast<int>((photos + block_size - 1) / block_size);
    return {
        .name = "matching",
        .program = "colmap",
        .arguments = {"exhaustive_matcher", "--ExhaustiveMatching.block_size", std::to_string(block_size)},
        .total = blocks * blocks,
        .parts_done = blocks_done};
}

/// Throws `error` for names that a list of pairs cannot have. COLMAP separates names by spaces.
void check_names(const photo_set& photos) {
    if (matches_exhaustively(photos)) return;
    for (const std::string& name : photos.names)
        if (name.find(' ') != std::string::npos)
            throw error("COLMAP cannot match more than " + std::to_string(most_exhaustive) +
                        " photos with spaces in their names: rename " + sanitize_for_message(name));
}

/// Writes the pairs to match to `list`.
stage pairs_stage(const std::vector<std::string>& names, const fs::path& list) {
    const auto pairs = pairs_to_match(names.size());
    atomic_file_write(list, [&](std::ostream& out) {
        for (const auto& [one, other] : pairs) out << names[one] << ' ' << names[other] << '\n';
    });
    return {.name = "matching",
            .program = "colmap",
            .arguments = {"matches_importer", "--match_type", "pairs", "--match_list_path", list},
            .total = static_cast<int>((pairs.size() + pairs_per_block - 1) / pairs_per_block),
            .parts_done = blocks_done};
}

void match(const photo_set& photos, const fs::path& result, stage_runner& runner, const listener& user) {
    const stopwatch watch;
    const bool all = matches_exhaustively(photos);
    const fs::path list = result / "pairs.txt";
    stage one = all ? exhaustive_stage(photos.names.size()) : pairs_stage(photos.names, list);
    for (const std::string& argument : {std::string("--database_path"), (result / "database.db").string(),
                                        std::string("--SiftMatching.use_gpu"), std::string("0")})
        one.arguments.push_back(argument);
    runner.require(one);
    fs::remove(list);
    user.say((all ? "matching of each photo with all others: "
                  : "matching of each photo with its neighbors in the order of names: ") +
             watch.text());
}

/// The models that the mapper has written, each with the names of its photos.
std::map<fs::path, std::set<std::string>> written_models(const fs::path& folder) {
    std::map<fs::path, std::set<std::string>> models;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.is_directory()) continue;
        const colmap_model model = read_colmap_model(entry.path());
        for (const colmap_image& one : model.images) models[entry.path()].insert(model.name(one));
    }
    return models;
}

std::string names_text(const std::vector<std::string>& names) {
    constexpr std::size_t most_shown = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), most_shown); ++i)
        text += (i == 0 ? "" : ", ") + sanitize_for_message(names[i]);
    return text + (names.size() > most_shown ? ", ..." : "");
}

constexpr const char* advice =
    ": take sharp photos with steady light, each of which shows at least half of what the one before shows";

/// Warns if many photos have no pose. Throws `error` if almost all have none.
void check_registered(const photo_set& photos, const std::set<std::string>& registered,
                      const listener& user) {
    const std::size_t count = photos.names.size();
    const std::string counts = std::to_string(registered.size()) + " of " + std::to_string(count) + " photos";
    if (registered.size() < fewest_photos) throw error("too few photos have poses (" + counts + ")" + advice);
    if (10 * registered.size() >= 9 * count) return;
    std::vector<std::string> missing;
    std::ranges::set_difference(photos.names, registered, std::back_inserter(missing));
    user.say("warning: only " + counts + " have poses; training does not use the others (" +
             names_text(missing) + ")");
}

/// Keeps the model with the most photos.
void keep_largest_model(const photo_set& photos, const fs::path& models_folder, const fs::path& result,
                        const std::string& time, const listener& user) {
    const auto models = written_models(models_folder);
    const auto largest =
        std::ranges::max_element(models, {}, [](const auto& model) { return model.second.size(); });
    check_registered(photos, largest == models.end() ? std::set<std::string>() : largest->second, user);
    fs::create_directory(result / "sparse");
    fs::rename(largest->first, result / "sparse/0");
    fs::remove_all(models_folder);
    user.say("poses of " + std::to_string(largest->second.size()) + " of " +
             std::to_string(photos.names.size()) + " photos" +
             (models.size() == 1
                  ? ""
                  : ", the largest of " + std::to_string(models.size()) + " models that share no points") +
             ": " + time);
}

void map_photos(const photo_set& photos, const fs::path& result, stage_runner& runner, const listener& user) {
    const stopwatch watch;
    const fs::path models = result / "models";
    fs::create_directory(models);
    const int status = runner.run({.name = "poses",
                                   .program = "colmap",
                                   .arguments = {"mapper", "--database_path", result / "database.db",
                                                 "--image_path", photos.folder, "--output_path", models},
                                   .total = static_cast<int>(photos.names.size()),
                                   .parts_done = images_registered});
    // The mapper also fails if it finds no model, for which the photos are the reason.
    if (status != 0 && status != 1)
        throw error("colmap failed at poses with exit status " + std::to_string(status) +
                    (runner.explanation().empty() ? "" : " (" + runner.explanation() + ")"));
    keep_largest_model(photos, models, result, watch.text(), user);
}

}  // namespace

bool matches_exhaustively(const photo_set& photos) {
    return !photos.are_frames && photos.names.size() <= most_exhaustive;
}

std::set<std::pair<std::size_t, std::size_t>> pairs_to_match(std::size_t photos) {
    constexpr std::size_t neighbors = 10, spaced_photos = 60;
    const std::size_t stride = (photos + spaced_photos - 1) / spaced_photos;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < photos; ++i) {
        for (std::size_t j = i + 1; j < std::min(i + 1 + neighbors, photos); ++j) pairs.emplace(i, j);
        if (i % stride == 0)
            for (std::size_t j = i + stride; j < photos; j += stride) pairs.emplace(i, j);
    }
    return pairs;
}

std::vector<std::vector<std::string>> groups_of_equal_size(const photo_set& photos) {
    std::map<std::pair<int, int>, std::vector<std::string>> by_size;
    for (const std::string& name : photos.names) {
        // COLMAP ignores the orientation in EXIF data.
        const image_header stored = read_image_header(photos.folder / name);
        by_size[{stored.width, stored.height}].push_back(name);
    }
    std::vector<std::vector<std::string>> groups;
    for (auto& [size, names] : by_size) groups.push_back(std::move(names));
    return groups;
}

void run_colmap(const photo_set& photos, const fs::path& result, stage_runner& runner, const listener& user) {
    check_names(photos);
    extract_features(photos, result, runner, user);
    match(photos, result, runner, user);
    map_photos(photos, result, runner, user);
}

}  // namespace gs::poses
