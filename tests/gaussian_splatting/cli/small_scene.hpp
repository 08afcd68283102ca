// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "../../support/bytes.hpp"
#include "image/image.hpp"
#include "run_program.hpp"

namespace gs_test {

inline constexpr int photo_width = 24, photo_height = 16;

/// A COLMAP scene with one camera and eight points; its members can make it invalid.
struct small_scene {
    int photos = 4;
    std::uint64_t cameras = 1;
    std::int32_t camera_model = 1;  // PINHOLE
    std::array<double, 4> rotation{1, 0, 0, 0};
    double depth = 4;
    double offset = 0, unit = 1;  ///< of coordinates: unit * (x + offset)

    double moved(double x) const { return unit * (x + offset); }

    std::string cameras_bin() const {
        bytes out;
        out.put(cameras);
        for (std::uint64_t i = 0; i < cameras; ++i) {
            out.put(std::uint32_t{1}).put(camera_model);
            out.put(std::uint64_t{photo_width}).put(std::uint64_t{photo_height});
            for (const double parameter : {24.0, 24.0, 12.0, 8.0}) out.put(parameter);
        }
        return out.data();
    }

    std::string images_bin() const {
        bytes out;
        out.put(static_cast<std::uint64_t>(photos));
        for (int i = 0; i < photos; ++i) {
            out.put(static_cast<std::uint32_t>(i + 1)).put(rotation);
            for (const double x : {0.1 * i, 0.0, depth}) out.put(unit * (x - offset));
            out.put(std::uint32_t{1}).put_text(photo(i)).put(std::uint64_t{0});
        }
        return out.data();
    }

    std::string points_bin() const {
        bytes out;
        out.put(std::uint64_t{8});
        for (unsigned i = 0; i < 8; ++i) {
            out.put(std::uint64_t{i + 1})
                .put(moved(i & 1 ? 0.5 : -0.5))
                .put(moved(i & 2 ? 0.5 : -0.5))
                .put(moved(i & 4 ? 0.5 : -0.5));
            out.put(std::array<std::uint8_t, 3>{200, 100, 50}).put(0.5).put(std::uint64_t{0});
        }
        return out.data();
    }

    static std::string photo(int i) { return "photo_" + std::to_string(i) + ".png"; }

    void write(const fs::path& folder) const {
        write_file(folder / "sparse/0/cameras.bin", cameras_bin());
        write_file(folder / "sparse/0/images.bin", images_bin());
        write_file(folder / "sparse/0/points3D.bin", points_bin());
        fs::create_directories(folder / "images");
        for (int i = 0; i < photos; ++i) write_photo(folder / "images" / photo(i), photo_width, photo_height);
    }

    static void write_photo(const fs::path& file, int w, int h) {
        gs::write_png(file, w, h, std::vector<float>(static_cast<std::size_t>(3 * w * h), 0.5F));
    }
};

/// A short training on the scene in `data`, without an output folder.
inline words training(const fs::path& data) {
    return {"train", "-d", data.string(), "-i", "5", "--device", "cpu"};
}

}  // namespace gs_test
