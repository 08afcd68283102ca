// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "model/morton_order.hpp"
#include "round_trip.hpp"
#include "writers/sog/sog.hpp"
#include "writers/sog/sog_images.hpp"
#include "writers/sog/zip_bundle.hpp"

namespace {

using gs_test::error_of;
using gs_test::random_model;
using gs_test::temporary_folder;
using json = nlohmann::ordered_json;

/// A .sog file, taken apart.
struct sog_parts {
    json meta;
    std::map<std::string, gs::rgba_image> images;

    explicit sog_parts(const gs::gaussians& model) {
        const temporary_folder folder;
        gs::sog_writer.write(folder / "a.sog", model, {});
        const gs::zip_bundle bundle(folder / "a.sog");
        meta = json::parse(bundle.read("meta.json", 1 << 20));
        for (const json& property : meta)
            if (property.is_object() && property.contains("files"))
                for (const json& file : property["files"]) {
                    const auto name = file.get<std::string>();
                    images[name] = gs::decoded_webp(bundle.read(name, 1 << 20)).value();
                }
    }

    std::string file() const {
        std::vector<gs::bundled_file> files{{"meta.json", meta.dump()}};
        for (const auto& [name, image] : images) files.push_back({name, gs::webp_of(image)});
        return gs::zip_of(files);
    }
    std::vector<int> pixel(const std::string& name, std::size_t i) {
        const std::uint8_t* p = images.at(name).pixel(i);
        return {p[0], p[1], p[2], p[3]};
    }
};

/// Returns the message of reading these bytes, without the name of the file.
std::string message_of_sog(const std::string& data) {
    const temporary_folder folder;
    const std::string file = (folder / "a.sog").string();
    gs_test::write_file(file, data);
    const std::string problem = error_of([&] { gs::sog_writer.read(file); });
    REQUIRE(problem.starts_with(file + ": "));
    return problem.substr(file.size() + 2);
}

}  // namespace

TEST_CASE("sog: images have the pixels of the format") {
    gs::gaussians model = random_model(2, 1);
    model.mean = {0, -1, 2, 1, 3, 2};
    model.log_scale = {-1, -2, -3, -3, -2, -1};
    model.quaternion = {0, 0, -2, 0, 1, 0, 0, 1};
    model.opacity = {0, 80};
    model.antialiased = true;
    sog_parts sog(model);
    CHECK(sog.meta["version"] == 2);
    CHECK(sog.meta["count"] == 2);
    CHECK(sog.meta["antialias"] == true);
    CHECK(sog.meta["model"] == "antialiased");
    CHECK(sog.meta["means"]["mins"][1].get<double>() == doctest::Approx(-std::log(2.0)));
    CHECK(sog.meta["means"]["maxs"][1].get<double>() == doctest::Approx(std::log(4.0)));
    // The first Gaussian has the smaller coordinates, so it is first on the Morton curve.
    CHECK(sog.pixel("means_l.webp", 0) == std::vector<int>{0, 0, 0, 255});
    CHECK(sog.pixel("means_u.webp", 1) == std::vector<int>{255, 255, 0, 255});
    CHECK(sog.pixel("quats.webp", 0) == std::vector<int>{128, 128, 128, 254});
    CHECK(sog.pixel("quats.webp", 1) == std::vector<int>{128, 128, 255, 252});
    CHECK(sog.pixel("sh0.webp", 0)[3] == 128);
    CHECK(sog.pixel("sh0.webp", 1)[3] == 255);
    const int scale = sog.pixel("scales.webp", 0)[2];
    CHECK(sog.meta["scales"]["codebook"][static_cast<std::size_t>(scale)] == -3);
    CHECK(sog.meta["shN"]["count"] == 2);
    CHECK(sog.images.at("shN_centroids.webp").width == 64 * 3);
}

TEST_CASE("sog: colors of transparent Gaussians are kept") {
    gs::gaussians model = random_model(20, 0);
    model.opacity.assign(20, -80);
    gs_test::check_same_gaussians(model, gs_test::read_back(gs::sog_writer, model),
                                  {1e-3, 0.1, 0.01, 0.002, 0.03, 0});
}

TEST_CASE("sog: antialiasing is kept") {
    gs::gaussians model = random_model(3, 0);
    CHECK_FALSE(gs_test::read_back(gs::sog_writer, model).antialiased);
    model.antialiased = true;
    CHECK(gs_test::read_back(gs::sog_writer, model).antialiased);
}

TEST_CASE("sog: the specified and the newer mark of antialiasing are read") {
    const temporary_folder folder;
    const auto is_antialiased = [&](const char* member, const json& value) {
        sog_parts sog(random_model(3, 0));
        sog.meta[member] = value;
        gs_test::write_file(folder / "a.sog", sog.file());
        return gs::sog_writer.read(folder / "a.sog").antialiased;
    };
    CHECK(is_antialiased("antialias", true));
    CHECK(is_antialiased("model", "antialiased"));
    CHECK_FALSE(is_antialiased("antialias", false));
    CHECK_FALSE(is_antialiased("antialias", 1));
    CHECK_FALSE(is_antialiased("model", "default"));
}

TEST_CASE("sog: one huge color leaves the others as they are") {
    gs::gaussians model = random_model(300, 0);
    model.sh_constant[0] = -1e9f;
    const gs::gaussians found = gs_test::read_back(gs::sog_writer, model);
    model.sh_constant[0] = 0;
    gs::gaussians without_first = found;
    for (float& x : without_first.sh_constant)
        if (x < -1e8f) x = 0;
    gs_test::check_same_gaussians(model, without_first, {1e-4, 0.02, 0.01, 0.002, 3.54 / 256, 0});
}

TEST_CASE("sog: view-dependent colors that cannot be clustered are refused, and no file is written") {
    const temporary_folder folder;
    gs::gaussians model = random_model(3, 1);
    model.sh_rest[2 * 9 + 4] = -3e38f;
    const auto file = folder / "a.sog";
    CHECK(
        error_of([&] { gs::sog_writer.write(file, model, {}); }) ==
        "cannot write " + file.string() +
            ": the view-dependent color of Gaussian 2 is beyond the range of SOG files, which ends at 10^9; "
            "use another format or --max-sh-degree 0");
    CHECK_FALSE(std::filesystem::exists(file));
    gs::sog_writer.write(file, model, {.max_sh_degree = 0});
    model = random_model(3, 2);
    model.sh_rest[23] = 1e9f;
    gs::sog_writer.write(file, model, {.max_sh_degree = 1});
}

TEST_CASE("sog: scales and colors are rounded to the nearest number of their codebooks") {
    const gs::gaussians model = random_model(700, 0);
    const sog_parts sog(model);
    const gs::gaussians found = gs_test::read_back(gs::sog_writer, model);
    const auto largest_half_gap = [&](const char* property) {
        const auto book = sog.meta[property]["codebook"].get<std::vector<double>>();
        double largest = 0;
        for (std::size_t i = 1; i < book.size(); ++i)
            largest = std::max(largest, (book[i] - book[i - 1]) / 2);
        return largest + 1e-6;
    };
    // The ends of a codebook are means of few values, so values beyond them are near, too.
    gs_test::check_same_gaussians(
        model, found, {1e-4, largest_half_gap("scales"), 0.0081, 0.002, largest_half_gap("sh0"), 0});
}

TEST_CASE("sog: the same model makes the same file") {
    const temporary_folder folder;
    for (const char* name : {"a.sog", "b.sog"})
        gs::sog_writer.write(folder / name, random_model(2000, 2), {});
    CHECK(gs_test::read_file(folder / "a.sog") == gs_test::read_file(folder / "b.sog"));
}

TEST_CASE("sog: a palette with less entries than Gaussians keeps colors on average") {
    gs::gaussians model = random_model(3000, 1);
    const auto check_colors = [&] {
        const gs::gaussians found = gs_test::read_back(gs::sog_writer, model);
        REQUIRE(found.sh_rest.size() == model.sh_rest.size());
        double before = 0, after = 0;
        for (const float x : model.sh_rest) before += double(x) * double(x);
        for (const float x : found.sh_rest) after += double(x) * double(x);
        CHECK(after > 0.8 * before);
        CHECK(after < before);
    };
    check_colors();
    model.log_scale[4] = 170;  // dwarfs all others
    check_colors();
    model.opacity.assign(3000, -80);
    check_colors();
}

TEST_CASE("sog: view-dependent colors are most precise for large and for opaque Gaussians") {
    const auto share_of_error = [](const std::function<void(gs::gaussians&, std::size_t)>& emphasize) {
        gs::gaussians model = random_model(3000, 1);
        model.opacity.assign(3000, -3);
        model.log_scale.assign(9000, -3);
        const auto is_emphasized = [](std::size_t i) { return i % 10 == 0; };
        for (std::size_t i = 0; i < 3000; ++i)
            if (is_emphasized(i)) emphasize(model, i);
        const gs::gaussians found = gs_test::read_back(gs::sog_writer, model);
        const std::vector<std::uint32_t> order = gs::morton_order(model.mean);
        double emphasized = 0, all = 0;
        for (std::size_t i = 0; i < found.sh_rest.size(); ++i) {
            const std::size_t original = order[i / 9];
            const double difference = double(found.sh_rest[i]) - double(model.sh_rest[9 * original + i % 9]);
            all += difference * difference;
            if (is_emphasized(original)) emphasized += difference * difference;
        }
        return emphasized / all;
    };
    CHECK(share_of_error([](gs::gaussians&, std::size_t) {}) > 0.05);
    CHECK(share_of_error([](gs::gaussians& m, std::size_t i) { m.opacity[i] = 3; }) < 0.02);
    // A Gaussian is as large as its largest scale.
    CHECK(share_of_error([](gs::gaussians& m, std::size_t i) { m.log_scale[3 * i + 1] = 3; }) < 0.02);
}

TEST_CASE("sog: malformed files are refused with the field") {
    const sog_parts whole(random_model(30, 1));
    const auto refused = [&](const std::function<void(sog_parts&)>& change) {
        sog_parts sog = whole;
        change(sog);
        return message_of_sog(sog.file());
    };
    CHECK(message_of_sog("PK is not enough") == "it is not a .zip archive, or is damaged");
    CHECK(refused([](sog_parts& s) { s.meta = json::array(); }) == "its meta.json has no 'version'");
    CHECK(refused([](sog_parts& s) { s.meta["version"] = 1; }) == "its version is not 2");
    CHECK(refused([](sog_parts& s) { s.meta["count"] = -1; }) == "its 'count' is not a whole number");
    CHECK(gs_test::says(refused([](sog_parts& s) { s.meta["count"] = std::uint64_t{1} << 60; }),
                        {"Gaussians are more than its", "bytes can hold"}));
    CHECK(gs_test::says(refused([](sog_parts& s) { s.meta["count"] = 1000000; }),
                        {"its 1000000 Gaussians are more than its", "bytes can hold"}));
    CHECK(refused([](sog_parts& s) { s.meta["count"] = 99; }) ==
          "its image 'means_l.webp' has 8x4 pixels for 99 values");
    CHECK(refused([](sog_parts& s) { s.images.erase("quats.webp"); }) ==
          "its file 'quats.webp' does not exist");
    CHECK(refused([](sog_parts& s) { s.meta["scales"]["codebook"].erase(0); }) ==
          "its 'codebook' is not 256 finite numbers");
    CHECK(refused([](sog_parts& s) { s.meta["means"]["maxs"][0] = 1e30; }) ==
          "the position of Gaussian 0 is not finite");
    CHECK(refused([](sog_parts& s) { s.images["quats.webp"].pixel(3)[3] = 251; }) ==
          "the rotation of Gaussian 3 has the tag 251 instead of 252 to 255");
    CHECK(refused([](sog_parts& s) {
              s.images["shN_labels.webp"].pixel(2)[1] = 200;
          }).starts_with("the color of Gaussian 2 is entry 51"));
    CHECK(refused([](sog_parts& s) { s.meta["shN"]["bands"] = 4; }) ==
          "its SH degree is 4, but 3 is the highest");
    CHECK(refused([](sog_parts& s) { s.meta["shN"]["bands"] = 2; }) ==
          "its image 'shN_centroids.webp' has 192x1 pixels for 240 values");
    CHECK(refused([](sog_parts& s) { s.meta["shN"]["count"] = 65537; }) ==
          "its palette has 65537 entries instead of 1 to 65536");
    CHECK(refused([](sog_parts& s) { s.meta["sh0"]["files"] = json::array({7}); }) ==
          "its 'sh0' has no file 0");
}
