// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "help.hpp"

#include <algorithm>
#include <sstream>

#include "apply_quality_preset.hpp"

namespace gs::cli {

namespace {

using options::alternatives;

constexpr std::size_t line_width = 100;

/// Fills lines of at most `line_width` characters that begin with `indent`.
std::string wrapped(const std::string& text, const std::string& indent) {
    std::istringstream words(text);
    std::string all, line;
    for (std::string word; words >> word;) {
        if (!line.empty() && indent.size() + line.size() + 1 + word.size() > line_width) {
            all += indent + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return all + indent + line + "\n";
}

/// The default as one would type it; empty if there is nothing to tell.
std::string default_of(const option& row) {
    if (!row.default_text.empty()) return row.default_text;
    const nlohmann::ordered_json value = row.value.json();
    if (row.value.is_flag())
        return value == true && row.is_recorded && !row.names.starts_with('!') ? "on" : "";
    return value.is_string() ? value.get<std::string>() : value.dump();
}

/// All sentences about an option. `required`: it has no default.
std::string description_of(const option& row, bool required) {
    std::string text = row.help + ".";
    if (!row.value.range.empty())
        text += " Accepts " + row.value.range + (row.unit.empty() ? "" : " " + row.unit) + ".";
    const std::string by_default = default_of(row);
    if (!required && !by_default.empty()) text += " Default: " + by_default + ".";
    if (!row.needs.empty()) text += " Needs " + alternatives(row.needs) + ".";
    if (!row.excludes.empty()) text += " Excludes " + alternatives(row.excludes) + ".";
    return text;
}

/// The headings, in the order of the table.
std::vector<std::string> groups_of(const std::vector<option>& rows) {
    std::vector<std::string> groups;
    for (const option& row : rows)
        if (std::ranges::find(groups, row.group) == groups.end()) groups.push_back(row.group);
    return groups;
}

std::string usage_of(command c, const std::vector<option>& rows) {
    std::string text = "gaussian_splatting " + name_of(c);
    for (const option& row : rows)
        if (row.is_required_by(c))
            text += row.is_positional() ? " " + row.value.type : " " + row.name() + " " + row.value.type;
    return text + " [OPTIONS]";
}

std::string names_with_type(const option& row) {
    std::string text;
    for (const std::string& name : row.all_names()) text += (text.empty() ? "" : ", ") + name;
    return row.value.is_flag() ? text : text + " " + row.value.type;
}

std::string commands_of(const option& row) {
    std::string text;
    for (const command c : row.commands)
        text += (text.empty() ? "" : ", ") + name_of(c) + (row.is_required_by(c) ? " (required)" : "");
    return text;
}

std::vector<option> rows_of(command c, const std::vector<option>& table) {
    std::vector<option> rows;
    std::ranges::copy_if(table, std::back_inserter(rows), [=](const option& o) { return o.belongs_to(c); });
    return rows;
}

}  // namespace

std::string overview() {
    std::string text =
        "Trains 3D Gaussian splatting models from photos, on a CPU or a GPU.\n\n"
        "Usage: gaussian_splatting COMMAND [OPTIONS]\n\nCommands:\n";
    for (const command c : all_values<command>) text += "  " + name_of(c) + "\n      " + purpose_of(c) + "\n";
    return text +
           "\nOptions instead of a command:\n"
           "  --help\n      Prints this text; after a command, prints the options of the command\n"
           "  --version\n      Prints the version\n"
           "  --print-reference\n      Prints the options of all commands as Markdown\n";
}

std::string help_text(command c, const std::vector<option>& rows) {
    std::string text = purpose_of(c) + ".\n\nUsage: " + usage_of(c, rows) + "\n";
    for (const std::string& group : groups_of(rows)) {
        text += "\n" + group + ":\n";
        for (const option& row : rows)
            if (row.group == group)
                text += "  " + names_with_type(row) + (row.is_required_by(c) ? "  (required)" : "") + "\n" +
                        wrapped(description_of(row, row.is_required_by(c)), "      ");
    }
    return text + "\nExplicit options override those of --quality. In names, _ and - are equal.\n";
}

std::string reference_page() {
    settings defaults;
    const std::vector<option> table = option_table(defaults);
    std::string text =
        "# Command line of the trainer\n\n"
        "<!-- Written by `gaussian_splatting --print-reference > docs/reference/cli.md`. -->\n\n"
        "The first word is a command; its options follow. In names of options, `_` and `-` are equal.\n"
        "`gaussian_splatting COMMAND --help` prints the options of one command, `--version` the version.\n"
        "`train` writes the values of all its options to `settings.json`, under their first long names\n"
        "with `_` for `-`. Defaults that depend on other options or on the scene appear there as the\n"
        "numbers that they came to.\n\n"
        "| command | purpose | usage |\n| --- | --- | --- |\n";
    for (const command c : all_values<command>)
        text +=
            "| `" + name_of(c) + "` | " + purpose_of(c) + " | `" + usage_of(c, rows_of(c, table)) + "` |\n";
    text += "\n| `--quality` | stands for |\n| --- | --- |\n";
    for (const quality_preset preset : all_values<quality_preset>) {
        const std::string options = options_of(preset);
        text += "| `" + name_of(preset) + "` | " + (options.empty() ? "the defaults" : "`" + options + "`") +
                " |\n";
    }
    for (const std::string& group : groups_of(table)) {
        text += "\n## " + group + "\n";
        for (const option& row : table)
            if (row.group == group)
                text += "\n- `" + names_with_type(row) + "`\\\n" +
                        wrapped("Commands: " + commands_of(row) + ".\\", "  ") +
                        wrapped(description_of(row, row.required == row.commands), "  ");
    }
    return text;
}

}  // namespace gs::cli
