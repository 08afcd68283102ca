// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "../evaluation/held_out_views.hpp"

namespace gs::cli {

/// Returns the measurements of held-out views for metrics.json: the means and the values of each
/// view. Values are null if there are no held-out views or if they are not finite.
nlohmann::ordered_json to_json(const evaluate::held_out_report& report);

/// Returns a table with one row per view and a last row of means. Missing values and values that
/// are not finite are empty.
/// @{
std::string to_csv(const evaluate::held_out_report& report);
std::string to_markdown(const evaluate::held_out_report& report);
/// @}

/// Writes metrics.json, and the tables metrics.csv and metrics.md, into a folder.
void write_metrics(const std::filesystem::path& folder, const nlohmann::ordered_json& metrics,
                   const evaluate::held_out_report& report);

/// Returns a text such as ", LPIPS 0.1234, 23.40 dB after fitting exposures" of the optional
/// measures that were computed.
std::string optional_measures(const evaluate::held_out_report& report);

/// Formats a value as printf does.
std::string number(const char* format, double value);

}  // namespace gs::cli
