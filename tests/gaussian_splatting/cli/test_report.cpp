// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "cli/report.hpp"

using gs::evaluate::held_out_report;
using gs::evaluate::view_quality;

namespace {

view_quality view(const std::string& name, double square_error, double ssim) {
    return {{.quality = {.absolute_error = 0, .square_error = square_error, .ssim = ssim}}, name};
}

held_out_report two_views() {
    held_out_report report{{view("a.png", 0.01, 0.5), view("b|\"1\",2.png", 0.001, 0.75)}, {}};
    report.views[0].ssim_interior = 0.25;
    report.views[0].psnr_8bit = 19.5;
    report.views[1].psnr_8bit = std::numeric_limits<double>::infinity();
    return report;
}

}  // namespace

TEST_CASE("metrics.csv has a row for each view and one for the mean") {
    CHECK(gs::cli::to_csv(two_views()) ==
          "name,psnr,ssim,ssim_interior,psnr_8bit\n"
          "a.png,20,0.5,0.25,19.5\n"
          "\"b|\"\"1\"\",2.png\",30,0.75,,\n"
          "mean,25,0.625,0.25,\n");
}

TEST_CASE("metrics.md has a row for each view and one for the mean") {
    CHECK(gs::cli::to_markdown(two_views()) ==
          "| view | PSNR (dB) | SSIM | SSIM, interior | PSNR of 8 bits (dB) |\n"
          "| --- | ---: | ---: | ---: | ---: |\n"
          "| a.png | 20.00 | 0.5000 | 0.2500 | 19.50 |\n"
          "| b\\|\"1\",2.png | 30.00 | 0.7500 |  |  |\n"
          "| **mean** | 25.00 | 0.6250 | 0.2500 |  |\n");
}

TEST_CASE("reports list LPIPS and fitted exposures only if a view has them") {
    held_out_report report = two_views();
    CHECK_FALSE(gs::cli::to_json(report).contains("lpips"));
    CHECK_FALSE(gs::cli::to_json(report).contains("fitted_psnr"));
    CHECK_FALSE(gs::cli::to_json(report).contains("lpips_input_range"));
    CHECK(gs::cli::optional_measures(report) == "");
    report.views[1].lpips = 0.125;
    report.views[0].fitted_psnr = 21;
    report.lpips_black = -1;
    const auto json = gs::cli::to_json(report);
    CHECK(json.at("lpips") == 0.125);
    CHECK(json.at("lpips_input_range") == std::vector<int>{-1, 1});
    CHECK(json.at("views")[0].at("lpips").is_null());
    CHECK(json.at("views")[1].at("lpips") == 0.125);
    CHECK(json.at("views")[0].at("fitted_psnr") == 21);
    CHECK(gs::cli::to_csv(report).starts_with("name,psnr,ssim,ssim_interior,psnr_8bit,lpips,fitted_psnr\n"));
    CHECK(
        gs::cli::to_markdown(report).starts_with("| view | PSNR (dB) | SSIM | SSIM, interior | PSNR of 8 "
                                                 "bits (dB) | LPIPS | PSNR, exposure fitted (dB) |"));
    CHECK(gs::cli::optional_measures(report) == ", LPIPS 0.1250, 21.00 dB after fitting exposures");
}

TEST_CASE("metrics.json begins with the means, and those of no views are null") {
    std::vector<std::string> keys;
    const auto json = gs::cli::to_json(held_out_report{});
    for (const auto& entry : json.items()) keys.push_back(entry.key());
    CHECK(keys == std::vector<std::string>{"psnr", "ssim", "ssim_interior", "psnr_8bit",
                                           "renders_rounded_to_8_bits", "views"});
    CHECK(json.at("psnr").is_null());
    CHECK(json.at("views").empty());
}
