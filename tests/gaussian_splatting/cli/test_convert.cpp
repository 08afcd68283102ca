// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/parse.hpp"
#include "edit/edit.hpp"
#include "run_program.hpp"
#include "writers/writer.hpp"

namespace {

using namespace gs_test;

/// Gaussians along x at 0, 1, 2 and so on, with opacities that fall from 0.95.
gs::gaussians row(std::size_t count) {
    gs::gaussians model;
    model.sh_degree = 1;
    for (std::size_t i = 0; i < count; ++i) {
        model.mean.insert(model.mean.end(), {static_cast<float>(i), 0.25f, 0.5f});
        model.quaternion.insert(model.quaternion.end(), {1, 0, 0, 0});
        model.opacity.push_back(3 - 0.5f * static_cast<float>(i));
    }
    model.log_scale.assign(3 * count, -4);
    model.sh_constant.assign(3 * count, 0.5f);
    model.sh_rest.assign(9 * count, 0.25f);
    return model;
}

/// A folder with the model `in.ply`, and what `convert` makes of it.
class conversion {
  public:
    explicit conversion(std::size_t count) { gs::write_model(file("in.ply"), row(count)); }

    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    outcome run_with(const words& options, const std::string& output = "out.ply") const {
        return run(words{"convert", file("in.ply"), file(output)} + options);
    }
    gs::gaussians result_of(const words& options, const std::string& output = "out.ply") const {
        const outcome o = run_with(options, output);
        CAPTURE(o.err);
        REQUIRE(o.code == 0);
        return gs::read_model(file(output));
    }
    std::vector<float> x_of(const words& options) const {
        const gs::gaussians model = result_of(options);
        std::vector<float> x;
        for (std::size_t i = 0; i < model.count(); ++i) x.push_back(model.mean[3 * i]);
        return x;
    }

  private:
    temporary_folder folder_;
};

}  // namespace

TEST_CASE("convert writes every format that its ending names, from every format that can be read") {
    const conversion c(5);
    for (const gs::writer* format : gs::all_writers()) {
        CAPTURE(format->name);
        const std::string name = "model" + std::string(format->endings[0]);
        CHECK(c.run_with({}, name).code == 0);
        if (!format->read) continue;
        CHECK(gs::read_model(c.file(name)).count() == 5);
        check_success({"convert", c.file(name), c.file("back.ply"), "--quiet"});
        CHECK(gs::read_model(c.file("back.ply")).count() == 5);
    }
}

TEST_CASE("convert crops, removes floaters and decimates, in this order") {
    const conversion c(20);
    CHECK(c.x_of({"--crop", "3,-1,-1,5.5,1,1"}) == std::vector<float>{3, 4, 5});
    CHECK(c.x_of({"--crop", "5.5,1,1,3,-1,-1"}) == std::vector<float>{3, 4, 5});
    CHECK(c.x_of({"--crop", "-1,-1,-1,0,1,1"}) == std::vector<float>{0});
    CHECK(c.x_of({"--decimate", "2"}) == std::vector<float>{0, 1});
    CHECK(c.x_of({"--decimate", "11%"}) == std::vector<float>{0, 1, 2});
    CHECK(c.x_of({"--crop", "3,-1,-1,9,1,1", "--decimate", "2"}) == std::vector<float>{3, 4});
    // Numbers 14 to 19 have an opacity below 0.02.
    CHECK(c.result_of({"--remove-floaters"}).count() == 14);
    CHECK(c.result_of({"--decimate", "50%", "--remove-floaters"}).count() == 7);
    CHECK(c.x_of({"--remove-floaters", "--crop", "13,-1,-1,19,1,1"}) == std::vector<float>{13});
    const outcome o = c.run_with({"--decimate", "2"});
    CHECK(says(o.out, {"--decimate keeps 2 of 20 Gaussians", "out.ply: 2 Gaussians, "}));
    CHECK(c.run_with({"--decimate", "2", "--quiet"}).out.empty());
}

TEST_CASE("convert removes Gaussians that the cameras of --data do not see") {
    const conversion c(3);
    // The cameras surround the origin and look downward, so they do not see the one far above it.
    gs::gaussians model = row(3);
    model.mean = {0, 0, 0, 0, 100, 0, 0, -100, 0};
    gs::write_model(c.file("in.ply"), model);
    CHECK(c.result_of({"--remove-floaters"}).count() == 3);
    CHECK(c.result_of({"--remove-floaters", "-d", "synthetic:spheres"}).mean.front() == 0);
    CHECK(c.result_of({"--remove-floaters", "-d", "synthetic:spheres"}).count() == 2);
    check_refusal({"convert", c.file("in.ply"), c.file("out.ply"), "-d", "synthetic:spheres"},
                  {"--data", "--remove-floaters"});
}

TEST_CASE("convert drops SH coefficients, and turns the axis that points up to -y") {
    const conversion c(2);
    CHECK(c.result_of({"--max-sh-degree", "0"}).sh_rest.empty());
    CHECK(c.result_of({"--up", "-y"}).mean == c.result_of({}).mean);
    const gs::gaussians turned = c.result_of({"--up", "z"});
    CHECK(turned.mean[1] == doctest::Approx(-0.5));
    CHECK(turned.mean[2] == doctest::Approx(0.25));
    CHECK(turned.mean[3] == doctest::Approx(1));
}

TEST_CASE("convert writes version 3 of SPZ on demand, which is a gzip file") {
    const conversion c(2);
    c.result_of({}, "a.spz");
    c.result_of({"--spz-version", "3"}, "b.spz");
    CHECK(read_file(c.file("a.spz")).starts_with("NGSP"));
    CHECK(read_file(c.file("b.spz")).starts_with("\x1f\x8b"));
}

TEST_CASE("convert warns about what the format cannot hold") {
    const conversion c(2);
    CHECK(says(c.run_with({}, "a.splat").out, {"warning:", "a.splat leaves out", "view dependence"}));
    CHECK_FALSE(says(c.run_with({}, "a.spz").out, {"warning:"}));
    CHECK_FALSE(says(c.run_with({"--max-sh-degree", "0"}, "a.splat").out, {"warning:"}));
    CHECK(c.run_with({"--quiet"}, "a.splat").out.empty());
}

TEST_CASE("convert writes the learned background as Gaussians if the format cannot hold it, or on demand") {
    const conversion c(2);
    gs::gaussians model = row(2);
    model.sky.assign(gs::sky_width, 0.25f);
    gs::write_model(c.file("in.ply"), model);
    constexpr std::size_t more = 2 + gs::edit::sky_count;

    CHECK(c.result_of({}).sky == model.sky);
    CHECK(c.result_of({}).count() == 2);
    CHECK(c.result_of({}, "a.spz").count() == more);
    CHECK(c.result_of({"--sky", "gaussians"}).count() == more);
    CHECK(c.result_of({"--sky", "gaussians"}).sky.empty());
    CHECK(c.result_of({"--sky", "none"}).sky.empty());
    CHECK(c.result_of({"--sky", "none"}, "a.spz").count() == 2);
    CHECK(says(c.run_with({}, "b.glb").out, {"learned background", std::to_string(more - 2)}));
}

TEST_CASE("convert clusters colors on the device of --device") {
    const conversion c(5);
    CHECK(c.result_of({"--device", "cpu"}, "a.sog").count() == 5);
#if defined(WARPAGG_TEST_CUDA)
    CHECK(c.result_of({"--device", "cuda"}, "b.sog").count() == 5);
#else
    check_refusal({"convert", c.file("in.ply"), c.file("b.sog"), "--device", "cuda"},
                  {"--device cuda", "GPU"});
    CHECK_FALSE(fs::exists(c.file("b.sog")));
    CHECK(c.result_of({"--device", "cuda"}, "b.spz").count() == 5);  // clusters no colors
    CHECK(c.result_of({"--device", "cuda", "--max-sh-degree", "0"}, "b.sog").count() == 5);  // nor this
#endif
}

TEST_CASE("convert refuses files and values that it cannot use, and leaves files as they are") {
    const conversion c(3);
    const std::string in = c.file("in.ply"), out = c.file("out.ply");
    const std::string before = read_file(in);
    check_refusal({"convert", in, in}, {in, "its own input", "another name"});
    check_refusal({"convert", c.file("none.ply"), out}, {"none.ply"});
    check_refusal({"convert", in, c.file("a.xyz")}, {"a.xyz", ".compressed.ply"});
    check_refusal({"convert", in, c.file("none/a.ply")}, {"none/a.ply", "No such file"});
    check_refusal({"convert", in}, {"output"});
    check_refusal({"convert", in, out, "more"}, {"'more'"});
    for (const char* box : {"1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,x", "nan,0,0,1,1,1", "1 2 3 4 5 6", ""})
        check_refusal({"convert", in, out, "--crop", box}, {"--crop", "six numbers"});
    for (const char* count : {"0", "-1", "0%", "101%", "%", "x%", "1e3"})
        check_refusal({"convert", in, out, "--decimate", count}, {"--decimate", count});
    check_refusal({"convert", in, out, "--up", "w"}, {"--up", "-z", "'w'"});
    check_refusal({"convert", in, out, "--up"}, {"--up", "needs a value"});
    check_refusal({"convert", in, out, "--up", "--remove-floater"},
                  {"--remove-floater", "--remove-floaters"});
    check_refusal({"convert", in, out, "--spz-version", "2"}, {"--spz-version", "3 to 4"});
    check_refusal({"convert", in, out, "--spz-version", "3"}, {"--spz-version", out, ".spz"});
    CHECK(read_file(in) == before);
    CHECK_FALSE(fs::exists(out));
}
