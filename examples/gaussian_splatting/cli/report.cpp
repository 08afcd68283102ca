// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <cstdio>

#include "../core/atomic_file_write.hpp"

namespace gs::cli {

nlohmann::ordered_json to_json(const evaluate::held_out_report& report) {
    nlohmann::ordered_json json;
    json["psnr"] = nullptr;
    json["ssim"] = nullptr;
    json["views"] = nlohmann::ordered_json::array();
    if (report.views.empty()) return json;
    json["psnr"] = report.psnr();
    json["ssim"] = report.ssim();
    if (const auto fitted = report.fitted_psnr()) json["fitted_psnr"] = *fitted;
    for (const auto& v : report.views) {
        json["views"].push_back({{"name", v.name}, {"psnr", v.quality.psnr()}, {"ssim", v.quality.ssim}});
        if (v.fitted_psnr) json["views"].back()["fitted_psnr"] = *v.fitted_psnr;
    }
    return json;
}

std::string fitted_part(const evaluate::held_out_report& report) {
    const auto fitted = report.fitted_psnr();
    return fitted ? ", " + number("%.2f", *fitted) + " dB after fitting exposures" : "";
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
    atomic_file_write(file, [&](std::ostream& out) {
        out << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
    });
}

std::string number(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace gs::cli
