// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "image/image.hpp"

namespace gs_test {

/// While it exists, `colmap`, `ffprobe` and `ffmpeg` are shell scripts with the behavior that its
/// members define.
class fake_programs {
  public:
    std::string models = "6";   ///< the number of photos with a pose in each model of the mapper
    std::string failing_stage;  ///< the command of colmap that prints an error and fails
    std::string hanging_stage;  ///< the command of colmap that reports a part and does not end
    bool has_broken_video = false;

    fake_programs() : earlier_path_(std::getenv("PATH")) {}
    fake_programs(const fake_programs&) = delete;
    fake_programs& operator=(const fake_programs&) = delete;
    ~fake_programs() { setenv("PATH", earlier_path_.c_str(), 1); }

    void install() const {
        install("colmap", colmap());
        install("ffprobe",
                has_broken_video ? "echo 'clip: Invalid data found'; exit 1\n" : "echo nb_read_packets=40\n");
        install("ffmpeg", ffmpeg());
        gs::write_png(folder_ / "frame.png", width, height, std::vector<float>(3 * width * height, 0.5F));
        setenv("PATH", (folder_.path().string() + ":" + earlier_path_).c_str(), 1);
    }
    /// Leaves only some of the programs on the path, and nothing else.
    void install_only(const std::vector<std::string>& names) const {
        install();
        for (const char* name : {"colmap", "ffprobe", "ffmpeg"})
            if (std::ranges::find(names, name) == names.end()) std::filesystem::remove(folder_ / name);
        setenv("PATH", folder_.path().c_str(), 1);
    }

    /// Returns the command lines of all calls, one a line, and forgets them.
    std::string calls() const {
        const std::string text = read_file(folder_ / "calls");
        std::filesystem::remove(folder_ / "calls");
        return text;
    }

    static constexpr int width = 12, height = 9;  ///< of each photo

  private:
    void install(const std::string& name, const std::string& commands) const {
        write_file(folder_ / name, "#!/bin/sh\nfakes='" + folder_.path().string() + "'\necho " + name +
                                       " \"$@\" >> \"$fakes/calls\"\n" + commands);
        std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
    }

    std::string colmap() const {
        return "models='" + models + "' failing='" + failing_stage + "' hanging='" + hanging_stage + "'\n" +
               R"sh(command=$1
shift
while [ $# -gt 0 ]; do
    case $1 in
        --output_path) output=$2 ;;
        --image_list_path) list=$2 ;;
        --database_path) database=$2 ;;
        --image_path | --SiftExtraction.use_gpu | --SiftExtraction.max_num_features) ;;
        --ImageReader.single_camera | --ImageReader.camera_model | --SiftMatching.use_gpu) ;;
        --ExhaustiveMatching.block_size | --match_type | --match_list_path) ;;
        *) echo "ERROR: Failed to parse options - unrecognised option '$1'."; exit 1 ;;
    esac
    shift 2
done
if [ "$command" = "$failing" ]; then
    echo "ERROR: the $command failed"
    echo "a line that follows"
    exit 1
fi
case $command in
    feature_extractor)
        cat "$list" >> "$database"
        while read -r name; do echo "Processed file [1/1]"; done < "$list" ;;
    exhaustive_matcher) echo "I1125 09:00:00 7 pairing.cc:1] Matching block [1/1, 1/1] in 0.1s" ;;
    matches_importer) echo "Matching block [1/1] in 0.1s" ;;
    mapper)
        index=0
        for count in $models; do
            mkdir "$output/$index"
            echo "1 SIMPLE_RADIAL 12 9 12 6 4.5 0.01" > "$output/$index/cameras.txt"
            head -n "$count" "$database" | while read -r name; do
                id=$((id + 1))
                echo "Registering image #$id ($id)"
                printf '%s 1 0 0 0 0.%s 0 4 1 %s\n\n' "$id" "$id" "$name" >> "$output/$index/images.txt"
            done
            for x in 1 2 3; do echo "$x $x 0 0 9 9 9 0.1"; done > "$output/$index/points3D.txt"
            index=$((index + 1))
        done
        [ "$index" -gt 0 ] ;;
esac
status=$?
[ "$command" != "$hanging" ] || sleep 60
exit $status
)sh";
    }

    /// Writes gray candidates, of which each fourth is sharp, or as many frames as the filter selects.
    std::string ffmpeg() const {
        return R"sh(for last; do
    case $last in select=*) filters=$last ;; esac
done
echo "frame=3"
case $* in
    *rawvideo*)
        for i in 0 1 2 3 4 5 6 7 8 9; do
            for source in /dev/zero /dev/zero /dev/zero "yes ab"; do
                case $source in yes*) $source ;; *) cat $source ;; esac | head -c 172800
            done
        done > "${last#file:}" ;;
    *)
        count=$(echo "$filters" | tr '+' '\n' | wc -l)
        i=0
        while [ $i -lt $count ]; do
            i=$((i + 1))
            cp "$fakes/frame.png" "${last%/*}/frame_0000$i.jpg"
        done ;;
esac
)sh";
    }

    temporary_folder folder_;
    std::string earlier_path_;
};

/// Writes photos with names that a shell would take apart.
inline void write_photos(const std::filesystem::path& folder, int count, int height = fake_programs::height) {
    constexpr int width = fake_programs::width;
    std::filesystem::create_directories(folder);
    for (int i = 0; i < count; ++i)
        gs::write_png(folder / ("a 'photo' $" + std::to_string(height * 100 + i) + ".png"), width, height,
                      std::vector<float>(static_cast<std::size_t>(3 * width * height), 0.5F));
}

}  // namespace gs_test
