// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "../evaluation/held_out_views.hpp"

namespace gs::cli {

/// The PSNR and SSIM of held-out views as metrics.json has them: the means and the values of each view. Null
/// if there are no held-out views or a value is not finite.
nlohmann::ordered_json to_json(const evaluate::held_out_report& report);

/// ", 23.40 dB after fitting exposures"; empty if no exposures were fitted.
std::string fitted_part(const evaluate::held_out_report& report);

/// Writes the whole file or leaves the one that is there. Throws `error`.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

/// `value` as `format` of printf prints it.
std::string number(const char* format, double value);

}  // namespace gs::cli
