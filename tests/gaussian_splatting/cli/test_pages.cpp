// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <string>

#include "cli/run_images.hpp"
#include "run_program.hpp"
#include "small_scene.hpp"
#include "small_training.hpp"

using namespace gs_test;

TEST_CASE("train writes a viewer and a report without paths of the machine") {
    const temporary_folder folder;
    check_success(small_training(folder / "run") + words{"-q"});
    const std::string viewer = read_file(folder / "run/viewer.html"),
                      report = read_file(folder / "run/report.html");
    CHECK(says(viewer, {"<title>synthetic:spheres</title>", "class=\"splat\">"}));
    CHECK(says(report, {"Worst view", "Best view", "held out", "--data synthetic:spheres", "--output run"}));
    for (const std::string& page : {viewer, report}) CHECK(page.find(folder.path().string()) == page.npos);
    const json history = read_json(folder / "run/metrics.json").at("history");
    CHECK(history.at("iteration") == json{60});
    CHECK(history.at("gaussians").size() == 1);
}

TEST_CASE("pages name a scene after its folder") {
    CHECK(gs::cli::last_part("/scenes/garden/") == "garden");
    CHECK(gs::cli::last_part("garden/images/..") == "garden");
    CHECK(gs::cli::last_part(".") == fs::current_path().filename());
    CHECK(gs::cli::last_part("synthetic:spheres") == "synthetic:spheres");
}

TEST_CASE("without --eval, the report shows training views") {
    const temporary_folder folder;
    check_success({"train", "-i", "20", "-o", folder / "run", "-d", "synthetic:spheres,views=4", "-r", "32",
                   "--device", "cpu", "-q"});
    CHECK(says(read_file(folder / "run/report.html"), {"<b>training views</b>", "Worst view", "Best view"}));
}

TEST_CASE("--no-viewer leaves out the viewer, and --viewer-size limits it") {
    const temporary_folder folder;
    check_success(small_training(folder / "none") + words{"-q", "--no-viewer"});
    CHECK(!fs::exists(folder / "none/viewer.html"));
    CHECK(fs::exists(folder / "none/report.html"));
    const outcome o = run({"train", "-i", "10", "-o", folder / "small", "-d", "synthetic:spheres,points=9000",
                           "-r", "32", "--device", "cpu", "--viewer-size", "200kB"});
    CHECK(o.code == 0);
    CHECK(says(o.out, {"viewer.html shows the", "most important of 9000", "at most 200kB"}));
    CHECK(fs::file_size(folder / "small/viewer.html") <= 200000);
    check_refusal(small_training(folder / "tiny") + words{"--viewer-size", "1kB"},
                  {"--viewer-size 1kB", "at least 200kB", "--no-viewer"});
}

TEST_CASE("--overwrite without a viewer leaves none of the earlier run") {
    const temporary_folder folder;
    check_success(small_training(folder / "run") + words{"-q"});
    check_success(small_training(folder / "run") + words{"-q", "--overwrite", "--no-viewer"});
    CHECK(!fs::exists(folder / "run/viewer.html"));
}

TEST_CASE("a resumed run has the history of both parts") {
    const temporary_folder folder;
    check_success(small_training(folder / "run") +
                  words{"-q", "--checkpoint-iterations", "30", "--test-iterations", "30"});
    fs::remove(folder / "run/metrics.json");
    for (const auto& file : fs::directory_iterator(folder / "run/checkpoints"))
        if (file.path().string().find("60") != std::string::npos) fs::remove_all(file.path());
    check_success(small_training(folder / "run") + words{"-q", "--resume"});
    CHECK(read_json(folder / "run/metrics.json").at("history").at("iteration") == json{30, 60});
}

TEST_CASE("compare writes a page about several runs") {
    const temporary_folder folder;
    const words few{"-d", "synthetic:spheres", "-r", "32", "--eval", "--device", "cpu", "-q", "--no-viewer"};
    check_success(words{"train", "-i", "10", "-o", folder / "a/run"} + few);
    check_success(words{"train", "-i", "20", "-o", folder / "b/run", "--seed", "5"} + few);
    check_success({"compare", folder / "a/run", folder / "b/run/", "-o", folder / "page.html"});
    const std::string page = read_file(folder / "page.html");
    CHECK(says(page, {"<th>run</th><th>run 2</th>", "Held-out PSNR", "Worst view",
                      "<th>seed</th><td>0</td><td>5</td>"}));
    CHECK(page.find(folder.path().string()) == page.npos);
}

TEST_CASE("compare refuses folders that are no runs") {
    const temporary_folder folder;
    check_refusal({"compare"}, {"compare needs runs"});
    check_refusal({"compare", folder / "a"}, {"at least two"});
    check_refusal({"compare", folder / "a", folder / "b"}, {"a", "no metrics.json"});
    write_file(folder / "a/metrics.json", "[1]");
    write_file(folder / "a/settings.json", "{");
    check_refusal({"compare", folder / "a", folder / "a", "-o", folder / "page.html"},
                  {"metrics.json", "no JSON object"});
    write_file(folder / "a/metrics.json", "{}");
    check_refusal({"compare", folder / "a", folder / "a", "-o", folder / "page.html"}, {"settings.json"});
    CHECK(!fs::exists(folder / "page.html"));
}

TEST_CASE("inspect --html writes the evidence for each effect") {
    const temporary_folder folder;
    const fs::path page_file = folder / "page.html";
    const words scene{"inspect", "-d", "synthetic:spheres,sky=0.7,exposure=0.3,views=12"};
    const outcome o = run(scene + words{"--html", page_file.string(), "-o", folder / "effects.json"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
    CHECK(says(o.out, {"page " + page_file.string()}));
    const std::string page = read_file(page_file);
    CHECK(says(page, {"Effects of synthetic:spheres,sky=0.7,exposure=0.3,views=12", "Training photos: 12",
                      "Darkest photo", "Most sky", "class=\"mark0\"", "<code>--effects auto,-sky</code>",
                      "<code>--effects auto,+direction</code>", "<code>--sh-degree 3</code>",
                      "<code>--background white</code>", "no training photo has masked pixels"}));
    const json effects = read_json(folder / "effects.json").at("effects");
    REQUIRE(effects.size() == 13);
    for (const json& effect : effects) {
        const auto name = effect.at("name").get<std::string>();
        CAPTURE(name);
        CHECK(says(page, {"id=\"" + name + "\"><h2>", effect.at("evidence").get<std::string>()}));
    }
    CHECK(page.find(folder.path().string()) == page.npos);
    CHECK(contents(folder.path()).size() == 2);
}

TEST_CASE("inspect --html shows photos of a scene without its folders") {
    const temporary_folder folder;
    small_scene scene;
    scene.write(folder / "secret/garden");
    check_success({"inspect", "-d", folder / "secret/garden", "--html", folder / "page.html"});
    const std::string page = read_file(folder / "page.html");
    CHECK(says(page, {"<title>Effects of garden</title>", "photo_0.png", "cannot decide"}));
    CHECK(page.find("secret") == page.npos);
}

TEST_CASE("inspect --html leaves an earlier page as it is if it fails, and refuses bad names first") {
    const temporary_folder folder;
    write_file(folder / "page.html", "earlier");
    check_refusal({"inspect", "-d", "synthetic:spheres,shine=1", "--html", folder / "page.html"},
                  {"'shine'"});
    CHECK(read_file(folder / "page.html") == "earlier");
    // The names are checked before the scene is read.
    const words broken{"inspect", "-d", "synthetic:none", "--html"};
    check_refusal(broken + words{folder.path().string()},
                  {folder.path().string(), "is a folder", "name a file"});
    check_refusal(broken + words{folder / "none/page.html"}, {folder / "none", "does not exist", "make it"});
    check_refusal(broken + words{folder / "page.html", "-o", folder / "page.html"},
                  {"--html and --output", "page.html", "different names"});
    CHECK(contents(folder.path()).size() == 1);
}
