// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/bytes.hpp"
#include "../../support/temporary_folder.hpp"
#include "engine/engine.hpp"
#include "image/image.hpp"
#include "writers/ply/ply.hpp"

namespace {

namespace fs = std::filesystem;
using gs_test::bytes;
using gs_test::read_file;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;
using words = std::vector<std::string>;
using json = nlohmann::json;

// ----------------------------------------------------------------------------------------- running the
// program

struct outcome {
    int code;  ///< of the exit; -1 for the end by a signal
    std::string out, err;
};

/// Replaces this process by the program, which writes to the two files.
[[noreturn]] void become_program(const words& arguments, const fs::path& out, const fs::path& err,
                                 const char* threads) {
    for (const auto& [file, descriptor] : {std::pair(out, STDOUT_FILENO), std::pair(err, STDERR_FILENO)}) {
        const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
    }
    if (threads) setenv("OMP_NUM_THREADS", threads, 1);
    setenv("OMP_WAIT_POLICY", "passive", 1);  // waiting threads leave a busy machine to others
    std::string name = WARPAGG_PROGRAM;
    words copies = arguments;
    std::vector<char*> argv{name.data()};
    for (std::string& argument : copies) argv.push_back(argument.data());
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
}

outcome run(const words& arguments, const char* threads = nullptr) {
    const temporary_folder streams;
    const fs::path out = streams / "out", err = streams / "err";
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) become_program(arguments, out, err, threads);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

words operator+(words some, const words& more) {
    some.insert(some.end(), more.begin(), more.end());
    return some;
}

std::string joined(const words& arguments) {
    std::string text;
    for (const std::string& argument : arguments) text += " " + argument;
    return text;
}

/// What lies in a folder: relative names, and the bytes of files.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        found[fs::relative(entry.path(), folder).string()] =
            entry.is_regular_file() ? read_file(entry.path()) : "a folder";
    return found;
}

// ------------------------------------------------------------------------------------------------ refusals

/// It ends with one line that says what is wrong, and names the culprit.
void check_refusal(const words& arguments, const words& culprits) {
    CAPTURE(joined(arguments));
    const outcome o = run(arguments);
    CAPTURE(o.err);
    CHECK(o.code > 0);
    CHECK(o.code < 126);
    CHECK(o.err.starts_with("error: "));
    CHECK(std::ranges::count(o.err, '\n') == 1);
    CHECK(o.err.ends_with('\n'));
    for (const std::string& culprit : culprits) {
        CAPTURE(culprit);
        CHECK(says(o.err, {culprit}));
    }
}

/// And it leaves no folder behind, nor touches one with earlier results.
void check_refusal_without_trace(const words& arguments, const words& culprits) {
    const temporary_folder folder;
    const fs::path fresh = folder / "new/results", earlier = folder / "earlier";
    check_refusal(arguments + words{"-o", fresh.string()}, culprits);
    CHECK(fs::is_empty(folder.path()));

    write_file(earlier / "metrics.json", "{}\n");
    write_file(earlier / "point_cloud/iteration_10/point_cloud.ply", "ply\n");
    const auto before = contents(earlier);
    check_refusal(arguments + words{"-o", earlier.string()}, culprits);
    CHECK(contents(earlier) == before);
}

// ------------------------------------------------------------------------------------- a small COLMAP scene

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr int width = 24, height = 16;

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
            out.put(std::uint64_t{width}).put(std::uint64_t{height});
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
        for (int i = 0; i < photos; ++i) write_photo(folder / "images" / photo(i), width, height);
    }

    static void write_photo(const fs::path& file, int w, int h) {
        gs::write_png(file, w, h, std::vector<float>(static_cast<std::size_t>(3 * w * h), 0.5F));
    }
};

words training(const fs::path& data) { return {"train", "-d", data.string(), "-i", "5", "--device", "cpu"}; }

void check_scene_is_refused(const small_scene& scene, const words& culprits, const words& options = {}) {
    const temporary_folder data;
    scene.write(data.path());
    check_refusal_without_trace(training(data.path()) + options, culprits);
}

/// `spoil` is done to a scene that is good.
template <class Spoil>
void check_spoilt_scene_is_refused(const Spoil& spoil, const words& culprits) {
    const temporary_folder data;
    small_scene{}.write(data.path());
    spoil(data.path());
    check_refusal_without_trace(training(data.path()), culprits);
}

// ---------------------------------------------------------------------------------------------- a small
// model

gs::gaussians small_model() {
    gs::gaussians model;
    for (const float x : {-0.5F, 0.0F, 0.5F}) {
        model.mean.insert(model.mean.end(), {x, 0, 0});
        model.log_scale.insert(model.log_scale.end(), {-2, -2, -2});
        model.quaternion.insert(model.quaternion.end(), {1, 0, 0, 0});
        model.opacity.push_back(1);
        model.sh_constant.insert(model.sh_constant.end(), {1, 0, -1});
    }
    return model;
}

void replace(std::string& text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    text.replace(at, what.size(), with);
}

/// `evaluate` and `render` of this model, from a good scene and without one.
void check_model_is_refused(const std::string& ply, const words& culprits) {
    const temporary_folder data;
    small_scene{}.write(data.path());
    check_refusal_without_trace({"evaluate", ply, "-d", data.path().string()}, culprits);
    check_refusal_without_trace({"render", ply, "-d", data.path().string()}, culprits);
    check_refusal_without_trace({"render", ply}, culprits);
}

const words train_spheres{"train", "-d", "synthetic:spheres"};

}  // namespace

TEST_CASE("a scene that is not there is refused") {
    const temporary_folder folder;
    check_refusal_without_trace(training(folder / "nowhere"), {(folder / "nowhere").string()});
    check_refusal_without_trace(training(folder.path()), {folder.path().string(), "is not a scene"});
    write_file(folder / "file", "x");
    check_refusal_without_trace(training(folder / "file"), {(folder / "file").string(), "is not a scene"});
    check_refusal_without_trace({"train", "-d", "synthetic:NOPE"}, {"NOPE", "spheres", "alpha"});
}

TEST_CASE("a scene with a wrong model is refused") {
    small_scene scene;
    SUBCASE("no cameras") {
        scene.cameras = 0;
        check_scene_is_refused(scene, {"cameras.bin", "no cameras"});
    }
    SUBCASE("an unknown camera model") {
        scene.camera_model = 77;
        check_scene_is_refused(scene, {"cameras.bin", "77", "PINHOLE"});
    }
    SUBCASE("a pose that is not a number") {
        scene.depth = not_a_number;
        check_scene_is_refused(scene, {"images.bin", "photo_0.png", "not finite"});
    }
    SUBCASE("a rotation that is not a number") {
        scene.rotation = {1, not_a_number, 0, 0};
        check_scene_is_refused(scene, {"images.bin", "photo_0.png", "not finite"});
    }
    SUBCASE("a rotation that is none") {
        scene.rotation = {0, 0, 0, 0};
        check_scene_is_refused(scene, {"images.bin", "photo_0.png", "rotation"});
    }
    SUBCASE("no images") {
        scene.photos = 0;
        check_scene_is_refused(scene, {"images.bin", "no images"});
    }
    SUBCASE("nothing left to train on") {
        scene.photos = 1;
        check_scene_is_refused(scene, {"no training views", "1 held out"}, {"--eval"});
    }
}

TEST_CASE("a scene with a file of the wrong length is refused") {
    for (const std::string name : {"cameras.bin", "images.bin", "points3D.bin"}) {
        const auto spoil = [&](const auto& change) {
            return [&, change](const fs::path& data) {
                const fs::path file = data / "sparse/0" / name;
                std::string text = read_file(file);
                change(text);
                write_file(file, text);
            };
        };
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text.resize(text.size() - 3); }),
                                      {name, "truncated"});
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text.clear(); }), {name, "truncated"});
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text += "more"; }), {name, "too long"});
        // A count that no memory could hold is not believed.
        check_spoilt_scene_is_refused(spoil([](std::string& text) { text[7] = '\x7f'; }),
                                      {name, "truncated"});
    }
}

TEST_CASE("a scene with a wrong photo is refused") {
    const auto photo = [](const fs::path& data) { return data / "images/photo_2.png"; };
    check_spoilt_scene_is_refused([&](const fs::path& data) { fs::remove(photo(data)); }, {"photo_2.png"});
    check_spoilt_scene_is_refused([](const fs::path& data) { fs::remove_all(data / "images"); }, {"images"});
    check_spoilt_scene_is_refused(
        [&](const fs::path& data) { write_file(photo(data), std::string(500, '\x5a')); }, {"photo_2.png"});
    check_spoilt_scene_is_refused([&](const fs::path& data) { write_file(photo(data), ""); },
                                  {"photo_2.png"});
    check_spoilt_scene_is_refused(
        [&](const fs::path& data) { small_scene::write_photo(photo(data), height, width); },
        {"photo_2.png", "wrong size", "16x24", "24x16"});
    // Half of a PNG has a good header.
    check_spoilt_scene_is_refused(
        [&](const fs::path& data) {
            const std::string whole = read_file(photo(data));
            write_file(photo(data), whole.substr(0, whole.size() / 2));
        },
        {"photo_2.png"});
    // The signature and the header of a picture of 0x0 pixels, with its right checksum.
    const std::string no_pixels{"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\0\0\0\0\0\x08\x02\0\0\0\xb4\xe9\xeb\x45",
                                33};
    check_spoilt_scene_is_refused([&](const fs::path& data) { write_file(photo(data), no_pixels); },
                                  {"photo_2.png"});
}

TEST_CASE("a model that is not sound is refused") {
    const temporary_folder folder;
    const fs::path file = folder / "model.ply";
    gs::write_ply(file, small_model());
    std::string text = read_file(file);
    SUBCASE("it is not there") {
        fs::remove(file);
        check_model_is_refused(file.string(), {file.string()});
    }
    SUBCASE("a field is missing") {
        replace(text, "property float opacity\n", "");
        write_file(file, text);
        check_model_is_refused(file.string(), {file.string(), "opacity"});
    }
    SUBCASE("the header promises more than there is") {
        replace(text, "element vertex 3", "element vertex 3000000");
        write_file(file, text);
        check_model_is_refused(file.string(), {file.string(), "3000000"});
    }
    SUBCASE("the header promises less than there is") {
        replace(text, "element vertex 3", "element vertex 2");
        write_file(file, text);
        check_model_is_refused(file.string(), {file.string()});
    }
    SUBCASE("it is no PLY") {
        write_file(file, "solid cube\n");
        check_model_is_refused(file.string(), {file.string()});
    }
    SUBCASE("it holds nothing to draw") {
        gs::write_ply(file, gs::gaussians());
        check_refusal_without_trace({"render", file.string()}, {file.string(), "no Gaussians"});
    }
}

TEST_CASE("an output that cannot be written is refused") {
    const temporary_folder folder;
    const fs::path data = folder / "scene", model = folder / "model.ply", file = folder / "file";
    small_scene{}.write(data);
    gs::write_ply(model, small_model());
    write_file(file, "mine");
    const auto before = contents(folder.path());
    const std::vector<words> commands{
        training(data), {"evaluate", model.string(), "-d", data.string()}, {"render", model.string()}};
    for (const words& command : commands)
        for (const std::string& output : words{file.string(), (file / "below").string(), "/proc/nope"})
            check_refusal(command + words{"-o", output}, {output});
    CHECK(contents(folder.path()) == before);
}

TEST_CASE("contradictory options are refused") {
    check_refusal_without_trace(train_spheres + words{"--white-background", "--background", "black"},
                                {"--white-background", "--background"});
    check_refusal_without_trace(train_spheres + words{"--test-every", "4"}, {"--test-every", "--eval"});
    check_refusal_without_trace(train_spheres + words{"-i", "20", "--test-iterations", "5"},
                                {"--test-iterations", "--eval"});
    check_refusal_without_trace(train_spheres + words{"-i", "20", "--save-iterations", "10", "21"},
                                {"--save-iterations", "21", "20"});
    check_refusal_without_trace(train_spheres + words{"--save-iterations", "0"}, {"--save-iterations", "0"});
    check_refusal_without_trace(
        train_spheres + words{"-i", "20", "--num-downscales", "2", "--resolution-schedule", "10"},
        {"--num-downscales 2", "--resolution-schedule 10", "20"});
    check_refusal_without_trace(
        train_spheres + words{"-i", "20", "--prune-share", "0.5", "--densify-until-iter", "20"},
        {"--prune-share", "--densify-until-iter", "at 20"});
    check_refusal_without_trace(train_spheres + words{"--budget", "2000", "--max-cap", "1999"},
                                {"--budget 2000", "--max-cap 1999"});
    check_refusal_without_trace(train_spheres + words{"--budget", "2000", "--densify-grad-threshold", "1e-4"},
                                {"--budget", "--densify-grad-threshold"});
    check_refusal_without_trace({"render", "model.ply", "--orbit-views", "3", "-d", "synthetic:spheres"},
                                {"--orbit-views", "--data"});
    check_refusal_without_trace({"render", "model.ply", "--eval"}, {"--eval", "--data"});
    check_refusal_without_trace({"render", "model.ply", "--images", "photos"}, {"--images", "--data"});
    check_refusal_without_trace({"render", "model.ply", "--background", "random"},
                                {"--background", "random"});
}

TEST_CASE("options that say nothing of a scene are refused, not ignored") {
    check_refusal_without_trace(train_spheres + words{"--images", "photos"}, {"--images", "synthetic"});
    check_refusal_without_trace(train_spheres + words{"--eval", "--test-every", "4"},
                                {"--test-every", "synthetic"});
}

TEST_CASE("an option that is not known is refused, and the nearest one named") {
    check_refusal_without_trace(train_spheres + words{"--itertions", "20"}, {"--itertions", "--iterations"});
    check_refusal_without_trace(train_spheres + words{"--sh_degre=2"}, {"--sh-degre", "--sh-degree"});
    check_refusal_without_trace({"render", "model.ply", "--orbit-vews", "3"},
                                {"--orbit-vews", "--orbit-views"});
    check_refusal_without_trace(train_spheres + words{"stray"}, {"stray"});
}

TEST_CASE("a command that is missing or not known is refused") {
    check_refusal({}, {"train", "evaluate", "render"});
    check_refusal({"trian", "-d", "synthetic:spheres"}, {"'trian'", "train", "evaluate", "render"});
    check_refusal({"--quiet", "train"}, {"'--quiet'", "train", "evaluate", "render"});
    check_refusal({"train", "-o", "nowhere"}, {"--data"});
    check_refusal({"train", "-d", "synthetic:spheres"}, {"--output"});
    check_refusal({"evaluate", "-d", "synthetic:spheres"}, {"ply"});
}

TEST_CASE("a number that makes no sense is refused") {
    const std::vector<std::array<std::string, 3>> cases{{"-r", "0", "--resolution"},
                                                        {"-r", "-3", "--resolution"},
                                                        {"-r", "1.5", "--resolution"},
                                                        {"-i", "0", "--iterations"},
                                                        {"-i", "abc", "--iterations"},
                                                        {"-i", "", "--iterations"},
                                                        {"-i", "5x", "--iterations"},
                                                        {"--sh-degree", "4", ""},
                                                        {"--sh-degree", "-1", ""},
                                                        {"--seed", "-1", ""},
                                                        {"--max-cap", "0", ""},
                                                        {"--sh-degree-interval", "0", ""},
                                                        {"--save-iterations", "abc", ""},
                                                        {"--position-lr-init", "nan", ""},
                                                        {"--position-lr-final", "0", ""},
                                                        {"--feature-lr", "inf", ""},
                                                        {"--opacity-lr", "-1e-3", ""},
                                                        {"--scaling-lr", "1e-60", ""},
                                                        {"--rotation-lr", "fast", ""},
                                                        {"--densify-grad-threshold", "nan", ""},
                                                        {"--opacity-reset-interval", "0", ""},
                                                        {"--densification-interval", "0", ""},
                                                        {"--densify-from-iter", "-1", ""},
                                                        {"--densify-until-iter", "1.5", ""},
                                                        {"--sh-lr", "0", ""},
                                                        {"--budget", "0", ""},
                                                        {"--prune-share", "1", ""},
                                                        {"--prune-share", "nan", "below 1"},
                                                        {"--prune-share", ".", "below 1"},
                                                        {"--num-downscales", "9", ""},
                                                        {"--resolution-schedule", "0", ""},
                                                        {"--sh-update-interval", "0", ""},
                                                        {"--background", "beige", ""},
                                                        {"--device", "tpu", ""},
                                                        {"--quality", "worst", ""},
                                                        {"-i", "99999999999999999999", "--iterations"}};
    for (const auto& [option, value, long_name] : cases)
        check_refusal_without_trace(train_spheres + words{option, value},
                                    {long_name.empty() ? option : long_name, value});
}

TEST_CASE("training that would not stay finite ends, and touches no earlier result") {
    check_refusal_without_trace({"train", "-d", "synthetic:spheres", "-r", "32", "-i", "20", "--device",
                                 "cpu", "-q", "--opacity-lr", "1e38"},
                                {"iteration 1", "view ", "opacity of Gaussian"});
}

TEST_CASE("inspect says what a scene calls for, and writes it") {
    const temporary_folder folder;
    const fs::path file = folder / "effects.json";
    const outcome o = run({"inspect", "-d", "synthetic:spheres,gloss=0.6,exposure=0.3", "-o", file.string()});
    CAPTURE(o.err);
    CHECK(o.code == 0);
    const auto json = nlohmann::json::parse(read_file(file));
    REQUIRE(json.at("effects").size() == 8);
    for (const auto& effect : json.at("effects")) {
        const auto name = effect.at("name").get<std::string>();
        CHECK(effect.at("called_for").get<bool>() == (name == "direction" || name == "exposure"));
        CHECK(says(o.out, {name, effect.at("evidence").get<std::string>(),
                           effect.at("expected").get<std::string>()}));
    }
    check_refusal({"inspect", "-d", "synthetic:spheres,shine=1"}, {"'shine'", "gloss"});
    check_refusal({"inspect", "-d", "synthetic:spheres", "-o", (folder / "none/effects.json").string()},
                  {"none"});
}

TEST_CASE("--device cuda is refused where there is no GPU") {
    std::string reason;
    if (gs::train::cuda_is_available(reason)) {
        MESSAGE("there is a GPU: not tested");
        return;
    }
    check_refusal_without_trace(train_spheres + words{"--device", "cuda"}, {"--device cuda", "GPU"});
}

// ---------------------------------------------------------------------------------------------- good paths

namespace {

const words small_spheres{"-d", "synthetic:spheres", "-r", "32", "--eval", "--device", "cpu"};

words small_training(const fs::path& output) {
    return words{"train", "-i", "60", "-o", output.string()} + small_spheres;
}

void check_success(const words& arguments, const char* threads = nullptr) {
    CAPTURE(joined(arguments));
    const outcome o = run(arguments, threads);
    CHECK(o.err == "");
    REQUIRE(o.code == 0);
}

json read_json(const fs::path& file) { return json::parse(read_file(file)); }

fs::path model_of(const fs::path& output, int iteration) {
    return output / "point_cloud" / ("iteration_" + std::to_string(iteration)) / "point_cloud.ply";
}

std::vector<std::string> pictures_in(const fs::path& folder, int expected_width, int expected_height) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const gs::image picture = gs::read_image(entry.path());
        CHECK(picture.width == expected_width);
        CHECK(picture.height == expected_height);
        names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

void check_metrics(const json& metrics) {
    CHECK(metrics.at("psnr").get<double>() > 15);
    CHECK(metrics.at("ssim").get<double>() > 0.3);
    CHECK(metrics.at("ssim").get<double>() < 1);
    REQUIRE(metrics.at("views").size() == 8);
    double sum = 0;
    for (const json& view : metrics.at("views")) {
        CHECK(view.at("name").get<std::string>().ends_with(".png"));
        CHECK(view.at("ssim").is_number());
        sum += view.at("psnr").get<double>();
    }
    CHECK(sum / 8 == doctest::Approx(metrics.at("psnr").get<double>()).epsilon(1e-12));
    for (const char* stage : {"load", "train", "evaluate"})
        CHECK(metrics.at("seconds").at(stage).is_number_float());
    CHECK(metrics.at("iterations") == 60);
    CHECK(metrics.at("gaussians").get<int>() > 0);
    CHECK(says(metrics.at("device").get<std::string>(), {"cpu"}));
    CHECK(metrics.at("accumulator") == "native");
    REQUIRE(!metrics.at("effects").empty());
    for (const json& effect : metrics.at("effects")) {
        CHECK(effect.at("name").is_string());
        CHECK(effect.at("on").is_boolean());
        CHECK(!effect.at("reason").get<std::string>().empty());
    }
    CHECK(metrics.at("seed") == 7);
}

}  // namespace

TEST_CASE("training writes a model, measures and pictures; evaluate and render read them") {
    const temporary_folder folder;
    const fs::path output = folder / "deep/results", model = model_of(output, 60);
    // One thread, as in evaluate below, adds up the errors of pixels in one order.
    const outcome trained = run(small_training(output) + words{"--seed", "7", "--save_iterations", "30",
                                                               "--sh_degree", "1", "--test_iterations", "20"},
                                "1");
    CHECK(trained.err == "");
    REQUIRE(trained.code == 0);
    CHECK(says(trained.out, {"held-out PSNR", model.string(), (output / "metrics.json").string()}));

    const json metrics = read_json(output / "metrics.json");
    check_metrics(metrics);
    REQUIRE(metrics.at("tests").size() == 1);
    const json& test = metrics.at("tests")[0];
    CHECK(test.at("iteration") == 20);
    CHECK(test.at("psnr").get<double>() < metrics.at("psnr").get<double>());
    CHECK(test.at("seconds").is_number_float());
    const json settings = read_json(output / "settings.json");
    CHECK(settings.at("data") == "synthetic:spheres");
    CHECK(settings.at("iterations") == 60);
    CHECK(settings.at("sh_degree") == 1);  // `_` and `-` are alike
    CHECK(settings.at("resolution") == 32);
    CHECK(settings.at("seed") == 7);

    CHECK(gs::read_ply(model_of(output, 30)).count() > 0);
    const gs::gaussians saved = gs::read_ply(model);
    CHECK(saved.sh_degree == 1);
    CHECK(saved.count() == metrics.at("gaussians").get<std::size_t>());
    const auto renders = pictures_in(output / "test/ours_60/renders", 32, 32);
    CHECK(renders.size() == 8);
    CHECK(pictures_in(output / "test/ours_60/gt", 32, 32) == renders);

    SUBCASE("evaluate measures the same") {
        const fs::path again = folder / "again";
        check_success(words{"evaluate", model.string(), "-o", again.string()} + small_spheres, "1");
        const json measured = read_json(again / "metrics.json");
        // The file holds every bit of the parameters.
        for (const char* measure : {"psnr", "ssim"}) CHECK(measured.at(measure) == metrics.at(measure));
        CHECK(measured.at("views").size() == metrics.at("views").size());
        CHECK(contents(again / "test") == contents(output / "test/ours_60"));
    }
    SUBCASE("evaluate without an output says it only") {
        const outcome said = run(words{"evaluate", model.string()} + small_spheres);
        CHECK(said.code == 0);
        CHECK(says(said.out, {"PSNR", "8 views"}));
    }
    SUBCASE("render from the scene's cameras draws what training drew") {
        const fs::path pictures = folder / "pictures";
        check_success(words{"render", model.string(), "-o", pictures.string()} + small_spheres);
        CHECK(pictures_in(pictures, 32, 32) == renders);
        CHECK(contents(pictures) == contents(output / "test/ours_60/renders"));
    }
    SUBCASE("render from the model alone draws an orbit") {
        const fs::path pictures = folder / "orbit";
        check_success({"render", model.string(), "-o", pictures.string(), "--orbit-views", "3", "-r", "40",
                       "--device", "cpu"});
        CHECK(pictures_in(pictures, 40, 40) == words{"00000.png", "00001.png", "00002.png"});
    }
}

TEST_CASE("a second training replaces the results of the first") {
    const temporary_folder folder;
    write_file(folder / "metrics.json", "{}\n");
    write_file(folder / "notes.txt", "mine");
    check_success(small_training(folder.path()) + words{"--quiet"});
    CHECK(read_json(folder / "metrics.json").at("iterations") == 60);
    CHECK(read_file(folder / "notes.txt") == "mine");
}

TEST_CASE("a scene of photos trains") {
    const temporary_folder folder;
    small_scene{}.write(folder / "scene");
    check_success(training(folder / "scene") + words{"-o", (folder / "results").string()});
    CHECK(read_json(folder / "results/metrics.json").at("psnr").is_null());  // no views were held out
}

TEST_CASE("a scene far from the origin, in another unit: the file has its coordinates, and all read it") {
    for (const auto& [offset, unit] : {std::pair(0.0, 1e-4), std::pair(1e4, 1.0), std::pair(0.0, 1e4)}) {
        CAPTURE(offset);
        CAPTURE(unit);
        const temporary_folder folder;
        small_scene scene;
        scene.offset = offset;
        scene.unit = unit;
        scene.write(folder / "scene");
        const fs::path output = folder / "results", again = folder / "again", model = model_of(output, 5);
        const words data{"-d", (folder / "scene").string(), "--eval", "--test-every", "2", "--device", "cpu"};
        check_success(words{"train", "-i", "5", "-o", output.string()} + data);
        const gs::gaussians saved = gs::read_ply(model);
        REQUIRE(saved.count() == 8);
        for (const float x : saved.mean)
            CHECK(std::abs(static_cast<double>(x) / unit - offset) == doctest::Approx(0.5).epsilon(0.1));
        for (const float s : saved.log_scale)
            CHECK(static_cast<double>(s) - std::log(unit) == doctest::Approx(0).epsilon(0.1));

        check_success(words{"evaluate", model.string(), "-o", again.string()} + data);
        const double psnr = read_json(output / "metrics.json").at("psnr").get<double>();
        CHECK(read_json(again / "metrics.json").at("psnr").get<double>() ==
              doctest::Approx(psnr).epsilon(1e-12));
        check_success(words{"render", model.string(), "-o", (folder / "pictures").string()} + data);
        CHECK(contents(folder / "pictures") == contents(output / "test/ours_5/renders"));

        // The orbit sees something, wherever it is.
        check_success({"render", model.string(), "-o", (folder / "orbit").string(), "--orbit-views", "1",
                       "-r", "40", "--device", "cpu"});
        const gs::image picture = gs::read_image(folder / "orbit/00000.png");
        CHECK(std::ranges::any_of(std::vector<std::uint8_t>(picture.rgba.begin() + 4 * (20 * 40 + 15),
                                                            picture.rgba.begin() + 4 * (20 * 40 + 25)),
                                  [](std::uint8_t level) { return level > 20 && level < 255; }));
    }
}

TEST_CASE("rates and intervals are options, by the reference implementation's names") {
    const temporary_folder folder;
    check_success(small_training(folder / "default") + words{"-q"});
    const json usual = read_json(folder / "default/settings.json");
    const json expected{{"position_lr_init", 1.6e-4},
                        {"position_lr_final", 1.6e-6},
                        {"feature_lr", 2.5e-3},
                        {"sh_lr", 2.5e-4},
                        {"opacity_lr", 2.5e-2},
                        {"scaling_lr", 1e-2},
                        {"rotation_lr", 1e-3},
                        {"opacity_reset_interval", 3000},
                        {"densification_interval", 100},
                        {"densify_from_iter", 500},
                        {"densify_until_iter", 30},
                        {"num_downscales", 1},
                        {"resolution_schedule", 12},
                        {"sh_update_interval", 1},
                        {"prune_share", 0},
                        {"budget", nullptr},
                        {"revised_opacity", true}};
    for (const auto& [name, value] : expected.items()) {
        CAPTURE(name);
        CHECK(usual.at(name) == value);
    }

    json others{{"position_lr_init", 1e-3},
                {"position_lr_final", 1e-5},
                {"feature_lr", 2e-3},
                {"opacity_lr", 3e-2},
                {"scaling_lr", 4e-3},
                {"rotation_lr", 2e-3},
                {"opacity_reset_interval", 25},
                {"densification_interval", 5},
                {"densify_from_iter", 10},
                {"densify_until_iter", 20},
                {"num_downscales", 2},
                {"resolution_schedule", 7},
                {"sh_update_interval", 2},
                {"sh_lr", 1e-3},
                {"budget", 1000},
                {"max_cap", 1001},
                {"prune_share", 0.5}};
    words options{"-q", "--no-revised-opacity"};
    for (const auto& [name, value] : others.items()) options = options + words{"--" + name, value.dump()};
    check_success(small_training(folder / "other") + options);
    const json chosen = read_json(folder / "other/settings.json");
    for (const auto& [name, value] : others.items()) {
        CAPTURE(name);
        CHECK(chosen.at(name) == value);
    }
    CHECK(chosen.at("revised_opacity") == false);
    // They are not only noted: it densifies before iteration 20.
    CHECK(read_json(folder / "other/metrics.json").at("gaussians") !=
          read_json(folder / "default/metrics.json").at("gaussians"));
}

TEST_CASE("--deterministic saves the same bytes again") {
    const temporary_folder folder;
    const auto trained = [&](const char* name, const words& options) {
        check_success(small_training(folder / name) + words{"-q"} + options);
        const json metrics = read_json(folder / name / "metrics.json");
        CHECK(read_json(folder / name / "settings.json").at("deterministic") == metrics.at("deterministic"));
        return metrics;
    };
    CHECK(trained("default", {}).at("deterministic") == false);
    for (const char* name : {"first", "again"})
        CHECK(trained(name, {"--deterministic"}).at("deterministic") == true);
    CHECK(contents(folder / "first/point_cloud") == contents(folder / "again/point_cloud"));
}

TEST_CASE("--quality fast sets what pays, and nothing that was said") {
    const temporary_folder folder;
    const words fast{"train",     "-r",  "16", "--device", "cpu", "-q", "-d", "synthetic:spheres",
                     "--quality", "fast"};
    const auto settings_of = [&](const char* name, const words& options) {
        check_success(fast + words{"-o", (folder / name).string()} + options);
        return read_json(folder / name / "settings.json");
    };
    const json expected{{"quality", "fast"}, {"iterations", 20}, {"sh_lr", 5e-4}};
    const json chosen = settings_of("chosen", {"-i", "20"});
    for (const auto& [name, value] : expected.items()) {
        CAPTURE(name);
        CHECK(chosen.at(name) == value);
    }
    const json said = settings_of("said", {"-i", "20", "--sh-lr", "1e-4"});
    CHECK(said.at("sh_lr") == 1e-4);
    check_success(small_training(folder / "balanced") + words{"-q", "--quality", "balanced"});
    check_success(small_training(folder / "default") + words{"-q"});
    const auto settings_without_output = [&](const char* name) {
        json settings = read_json(folder / name / "settings.json");
        settings.erase("output");
        return settings;
    };
    CHECK(settings_without_output("balanced") == settings_without_output("default"));
    check_refusal_without_trace(fast + words{"--save-iterations", "5001"}, {"5001", "1 to 5000"});
}

TEST_CASE("--quality best takes its time, and what was said") {
    const temporary_folder folder;
    const words best{"train",     "-r",  "16", "--device", "cpu", "-q", "-d", "synthetic:spheres",
                     "--quality", "best"};
    check_refusal_without_trace(best + words{"--save-iterations", "30001"}, {"30001", "1 to 30000"});
    check_success(best + words{"-o", (folder / "chosen").string(), "-i", "20"});
    CHECK(read_json(folder / "chosen/settings.json").at("densify_grad_threshold") == 5e-5);
    CHECK(read_json(folder / "chosen/settings.json").at("iterations") == 20);
    check_success(best + words{"-o", (folder / "said").string(), "-i", "20", "--budget", "900"});
    CHECK(read_json(folder / "said/settings.json").at("densify_grad_threshold") > 5e-5);
}

TEST_CASE("a fifth of what grew is pruned, but not of a budget, nor if it is said") {
    const temporary_folder folder;
    const auto share = [&](const char* name, const words& options) {
        check_success(small_training(folder / name) +
                      words{"-q", "--densify-from-iter", "10", "--densification-interval", "5"} + options);
        return read_json(folder / name / "settings.json").at("prune_share");
    };
    CHECK(share("default", {}) == 0.2);
    CHECK(share("budget", {"--budget", "900"}) == 0);
    CHECK(share("none", {"--prune-share", "0"}) == 0);
    CHECK(share("both", {"--budget", "900", "--prune-share", "0.1"}) == 0.1);
}

TEST_CASE("train simulates what the scene calls for, or what it is told, and says so") {
    const temporary_folder folder;
    const auto effects = [&](const std::string& name, const std::string& scene, const words& options) {
        check_success(words{"train", "-q", "-r", "96", "--eval", "-i", "20", "--device", "cpu", "-d", scene,
                            "-o", (folder / name).string()} +
                      options);
        std::map<std::string, bool> on;
        const json metrics = read_json(folder / name / "metrics.json");
        for (const json& e : metrics.at("effects"))
            on[e.at("name").get<std::string>()] = e.at("on").get<bool>();
        return on;
    };
    using set = std::map<std::string, bool>;
    const std::string varied = "synthetic:spheres,exposure=0.5,scales=4";
    CHECK(effects("auto", varied, {}) == set{{"direction", false},
                                             {"exposure", true},
                                             {"antialiasing", true},
                                             {"sky", false},
                                             {"masks", false},
                                             {"depth", false},
                                             {"background", false}});
    const json found = read_json(folder / "auto/exposures.json");
    CHECK(found.at("train").size() == 40);
    CHECK(found.at("train").at("view_00.png").size() == 3);
    CHECK(found.at("train").at("view_00.png")[2].size() == 4);
    CHECK(found.at("test").size() == 8);
    const json metrics = read_json(folder / "auto/metrics.json");
    CHECK(metrics.at("fitted_psnr").is_number());
    CHECK(metrics.at("views")[0].at("fitted_psnr").is_number());
    const std::string model = (folder / "auto/point_cloud/iteration_20/point_cloud.ply").string();
    CHECK(says(read_file(model).substr(0, 100), {"comment SplatRenderMode: mip\n"}));

    CHECK(effects("some", varied, {"--effects=-exposure,+direction"}) == set{{"direction", true},
                                                                             {"exposure", false},
                                                                             {"antialiasing", true},
                                                                             {"sky", false},
                                                                             {"masks", false},
                                                                             {"depth", false},
                                                                             {"background", false}});
    CHECK(!fs::exists(folder / "some/exposures.json"));
    CHECK(!read_json(folder / "some/metrics.json").contains("fitted_psnr"));
    CHECK(effects("degree", varied, {"--effects", "none", "--sh-degree", "2"}).at("direction"));
    CHECK(read_json(folder / "degree/metrics.json").at("effects")[0].at("sh_degree") == 2);

    // What was trained with a filter is drawn with it, and without it looks otherwise.
    const auto psnr = [&](const std::string& ply) {
        const outcome o =
            run({"evaluate", ply, "-d", varied, "-r", "96", "--device", "cpu", "--eval", "--fit-exposure"});
        CHECK(says(o.out, {"after fitting exposures"}));
        return o.out;
    };
    std::string plain = read_file(model);
    plain.erase(plain.find("comment"), std::string("comment SplatRenderMode: mip\n").size());
    write_file(folder / "plain.ply", plain);
    CHECK(psnr(model) != psnr((folder / "plain.ply").string()));

    check_refusal_without_trace(train_spheres + words{"--effects", "glare"}, {"'glare'", "antialiasing"});
}

TEST_CASE("--quiet prints nothing") {
    const temporary_folder folder;
    const outcome o = run(small_training(folder.path()) + words{"--quiet"});
    CHECK(o.code == 0);
    CHECK(o.out == "");
    CHECK(o.err == "");
}

TEST_CASE("the same seed on one thread gives the same file, to the byte") {
    const temporary_folder folder;
    for (const char* name : {"one", "two"})
        check_success(small_training(folder / name) + words{"--quiet", "--seed", "3"}, "1");
    check_success(small_training(folder / "other") + words{"--quiet", "--seed", "4"}, "1");
    const std::string one = read_file(model_of(folder / "one", 60));
    CHECK(!one.empty());
    CHECK(one == read_file(model_of(folder / "two", 60)));
    CHECK(one != read_file(model_of(folder / "other", 60)));
}

TEST_CASE("help and version are no errors") {
    for (const words& asked : {words{"--help"}, words{"train", "--help"}, words{"--version"}}) {
        const outcome o = run(asked);
        CHECK(o.code == 0);
        CHECK(!o.out.empty());
        CHECK(o.err == "");
    }
}
