// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "../evaluation/held_out_views.hpp"

namespace gs::cli {

/// Returns the PSNR and SSIM of held-out views for metrics.json: the means and the values of each
/// view. Values are null if there are no held-out views or if they are not finite.
nlohmann::ordered_json to_json(const evaluate::held_out_report& report);

/// Returns a text such as ", 23.40 dB after fitting exposures", or an empty text if no exposures
/// were fitted.
std::string fitted_part(const evaluate::held_out_report& report);

/// Writes a file as a whole or not at all: see `atomic_file_write`.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

/// Formats a value as printf does.
std::string number(const char* format, double value);

}  // namespace gs::cli
