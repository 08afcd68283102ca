// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <map>
#include <string>

#include "engine/engine.hpp"
#include "run_program.hpp"
#include "small_scene.hpp"
#include "small_training.hpp"

using namespace gs_test;

TEST_CASE("--init selects the first points, and the program says so if they are not those of the scene") {
    const temporary_folder folder;
    small_scene scene;
    scene.write(folder / "scene");
    const auto trained = [&](const char* init) {
        return run({"train", "-d", (folder / "scene").string(), "-o", (folder / init).string(), "--init",
                    init, "--device", "cpu", "-i", "2"});
    };
    CHECK(trained("auto").out.find("begins with") == std::string::npos);  // the photos are smooth
    CHECK(trained("given").out.find(" 8 Gaussians") != std::string::npos);
    CHECK(says(trained("random").out, {"begins with random points", " 5001 Gaussians"}));
    const outcome refused = trained("stereo");
    CHECK(refused.code == 2);
    CHECK(says(refused.err, {"stereo finds only 0 points", "use --init auto"}));
}

TEST_CASE("--save-cameras writes a COLMAP model, with which the photos can be trained again") {
    const temporary_folder folder;
    small_scene().write(folder / "scene");
    const words options{"--device", "cpu", "-i", "8", "-q"};
    const std::string out = (folder / "out").string(), photos = (folder / "scene/images").string();
    check_success(
        words{"train", "-d", (folder / "scene").string(), "-o", out, "--save-cameras", "--effects", "poses"} +
        options);
    check_success(
        words{"train", "-d", out + "/cameras", "--images", photos, "-o", (folder / "again").string()} +
        options);
    CHECK(contents(folder / "out/cameras/sparse/0").size() == 3);
}

TEST_CASE("settings.json records rates and intervals, and training uses them") {
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

TEST_CASE("--deterministic writes the same model twice") {
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

TEST_CASE("--quality fast does not override explicit options") {
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
        for (const char* name_only : {"output", "given"}) settings.erase(name_only);
        return settings;
    };
    CHECK(settings_without_output("balanced") == settings_without_output("default"));
    check_refusal_without_trace(fast + words{"--save-iterations", "5001"}, {"5001", "1 to 5000"});
}

TEST_CASE("--quality best does not override explicit options") {
    const temporary_folder folder;
    const words best{"train",     "-r",  "16", "--device", "cpu", "-q", "-d", "synthetic:spheres",
                     "--quality", "best"};
    check_refusal_without_trace(best + words{"--save-iterations", "30001"}, {"30001", "1 to 30000"});
    check_success(best + words{"-o", (folder / "chosen").string(), "-i", "20"});
    CHECK(read_json(folder / "chosen/settings.json").at("iterations") == 20);
}

TEST_CASE("--prune-share is 0.2 after densification, 0 with --budget, and as given") {
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

TEST_CASE("train simulates the effects that the scene needs or that are given") {
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
                                             {"vignetting", false},
                                             {"exposure", true},
                                             {"response", false},
                                             {"antialiasing", true},
                                             {"sky", false},
                                             {"poses", false},
                                             {"motion", false},
                                             {"moving", false},
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
                                                                             {"vignetting", false},
                                                                             {"exposure", false},
                                                                             {"response", false},
                                                                             {"antialiasing", true},
                                                                             {"sky", false},
                                                                             {"poses", false},
                                                                             {"motion", false},
                                                                             {"moving", false},
                                                                             {"masks", false},
                                                                             {"depth", false},
                                                                             {"background", false}});
    CHECK(!fs::exists(folder / "some/exposures.json"));
    CHECK(!fs::exists(folder / "some/poses.json"));
    CHECK(!fs::exists(folder / "some/vignetting.json"));
    CHECK(!fs::exists(folder / "some/response.json"));
    CHECK(!read_json(folder / "some/metrics.json").contains("fitted_psnr"));

    CHECK(effects("poses", "synthetic:spheres,poses=1", {"--effects", "poses"}).at("poses"));
    CHECK(read_json(folder / "poses/poses.json").size() == 40);
    const json refined = read_json(folder / "poses/metrics.json");
    CHECK(refined.at("refined_psnr").get<double>() > refined.at("psnr").get<double>());
    CHECK(refined.at("views")[0].at("refined_psnr").is_number());

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

TEST_CASE("the options of --strategy error change the model") {
    const temporary_folder folder;
    const auto model = [&](const char* name, const words& options) {
        check_success(words{"train", "-i", "1250", "-d", "synthetic:spheres,views=8,points=200", "-r", "32",
                            "--device", "cpu", "-q", "--deterministic", "--effects", "none", "-o",
                            (folder / name).string(), "--strategy", "error"} +
                      options);
        return read_file(model_of(folder / name, 1250));
    };
    const std::string usual = model("usual", {});
    CHECK((model("views", {"--error-views", "2"}) != usual));
    CHECK((model("level", {"--error-level", "0.005"}) != usual));
    CHECK((model("pixels", {"--error-pixels", "0.1"}) != usual));
}

TEST_CASE("the options of --strategy mcmc change the model") {
    const temporary_folder folder;
    const auto model = [&](const char* name, const words& options) {
        check_success(small_training(folder / name) + words{"-q", "--deterministic", "--strategy", "mcmc"} +
                      options);
        return read_file(model_of(folder / name, 60));
    };
    const std::string usual = model("usual", {});
    CHECK(model("noise", {"--mcmc-noise", "0"}) != usual);
    CHECK(model("opacity", {"--mcmc-opacity-penalty", "0.5"}) != usual);
    CHECK(model("scale", {"--mcmc-scale-penalty", "0.5"}) != usual);
}

TEST_CASE("--quiet prints nothing") {
    const temporary_folder folder;
    const outcome o = run(small_training(folder.path()) + words{"--quiet"});
    CHECK(o.code == 0);
    CHECK(o.out == "");
    CHECK(o.err == "");
}

TEST_CASE("one thread and the same seed write the same model twice") {
    const temporary_folder folder;
    for (const char* name : {"one", "two"})
        check_success(small_training(folder / name) + words{"--quiet", "--seed", "3"}, "1");
    check_success(small_training(folder / "other") + words{"--quiet", "--seed", "4"}, "1");
    const std::string one = read_file(model_of(folder / "one", 60));
    CHECK(!one.empty());
    CHECK(one == read_file(model_of(folder / "two", 60)));
    CHECK(one != read_file(model_of(folder / "other", 60)));
}

TEST_CASE("--device auto computes on the CPU where there is no GPU, and says why") {
    std::string reason;
    if (gs::train::cuda_is_available(reason)) {
        MESSAGE("there is a GPU: not tested");
        return;
    }
    const temporary_folder folder;
    const outcome o = run(train_spheres + words{"-r", "32", "-i", "2", "-o", (folder / "output").string()});
    CHECK(o.code == 0);
    CHECK(says(o.out, {"using the CPU: " + reason + "\n"}));
}
