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
constexpr std::size_t name_column = 32;  ///< columns for names in help texts

/// Breaks text into lines of at most `width` characters, which begin with `indent`.
std::string wrapped(const std::string& text, const std::string& indent, std::size_t width = line_width) {
    std::istringstream in(text);
    std::string all, line;
    for (std::string word; in >> word;) {
        if (!line.empty() && indent.size() + line.size() + 1 + word.size() > width) {
            all += indent + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return all + indent + line + "\n";
}

/// Returns the default as users type it, or an empty text if help texts do not show it.
std::string default_of(const option& row) {
    if (!row.default_text.empty()) return row.default_text;
    const nlohmann::ordered_json value = row.value.json();
    if (row.value.is_flag())
        return value == true && row.is_recorded && !row.names.starts_with('!') ? "on" : "";
    return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Returns all sentences about an option. `required`: the command requires it, so its default is
/// not shown.
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

/// Returns the headings in the order of the table.
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
    return text + (rows.empty() ? "" : " [OPTIONS]");
}

std::string names_with_type(const option& row) {
    std::string text;
    for (const std::string& name : row.all_names()) text += (text.empty() ? "" : ", ") + name;
    return row.value.is_flag() ? text : text + " " + row.value.type;
}

/// Returns the first short name and the first long name. The reference lists the other names.
std::string main_names(const option& row) {
    const std::vector<std::string> names = row.all_names();
    const auto short_name =
        std::ranges::find_if(names, [](const std::string& n) { return n.size() == 2 && n[0] == '-'; });
    return (short_name == names.end() ? "" : *short_name + ", ") + row.name() +
           (row.value.is_flag() ? "" : " " + row.value.type);
}

/// Returns the names of an option with its description, range and default beside them. Long texts
/// take several lines.
std::string help_line(const option& row, bool required) {
    std::string facts = required ? "required" : row.value.range;
    if (!facts.empty() && !required && !row.unit.empty()) facts += " " + row.unit;
    const std::string by_default = required ? "" : default_of(row);
    if (!by_default.empty()) facts += (facts.empty() ? "" : "; ") + ("default: " + by_default);
    const std::string text = row.help + (facts.empty() ? "" : " [" + facts + "]");
    const std::string names = "  " + main_names(row);
    std::string lines = wrapped(text, std::string(name_column, ' '), line_width + 10);
    if (names.size() + 2 > name_column) return names + "\n" + lines;
    return lines.replace(0, names.size(), names);
}

std::string commands_of(const option& row) {
    std::string text;
    for (const command c : row.commands)
        text += (text.empty() ? "" : ", ") + name_of(c) + (row.is_required_by(c) ? " (required)" : "");
    return text;
}

}  // namespace

const std::vector<program_option>& program_options() {
    static const std::vector<program_option> all{
        {"--help", "Prints this text; after a command, prints the options of the command"},
        {"--version", "Prints the version"},
        {"--print-reference", "Prints the options of all commands as Markdown"},
        {"--print-man-page", "Prints the manual page"},
        {"--print-completion", "Prints the completion script for a shell, bash or zsh", "SHELL"}};
    return all;
}

std::string overview() {
    std::string text =
        "Trains 3D Gaussian splatting models from photos, on a CPU or a GPU.\n\n"
        "Usage: gaussian_splatting COMMAND [OPTIONS]\n\nCommands:\n";
    for (const command c : all_values<command>) text += "  " + name_of(c) + "\n      " + purpose_of(c) + "\n";
    text += "\nOptions instead of a command:\n";
    for (const program_option& o : program_options())
        text += "  " + o.name + (o.type.empty() ? "" : " " + o.type) + "\n      " + o.help + "\n";
    return text;
}

std::string help_text(command c, const std::vector<option>& rows) {
    std::string text = purpose_of(c) + ".\n\nUsage: " + usage_of(c, rows) + "\n";
    for (const std::string& group : groups_of(rows)) {
        text += "\n" + group + ":\n";
        std::string rare;
        for (const option& row : rows) {
            if (row.group != group) continue;
            if (row.is_rare) {
                rare += " " + row.name();
            } else {
                text += help_line(row, row.is_required_by(c));
            }
        }
        if (!rare.empty()) text += wrapped("Rarely needed:" + rare, "  ");
    }
    return text + "\nDetails of all options: man gaussian_splatting, or docs/reference/cli.md\n";
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
        "numbers that they came to. The member `given` has the options of the command line only, and\n"
        "`--config` reads these.\n\n"
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

std::string man_page() {
    settings defaults;
    const std::vector<option> table = option_table(defaults);
    const auto escaped = [](const std::string& text) {
        std::string safe;
        for (const char c : text) safe += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
        return safe.starts_with('.') || safe.starts_with('\'') ? "\\&" + safe : safe;
    };
    std::string text = ".TH GAUSSIAN_SPLATTING 1 \"\" \"warpagg " WARPAGG_VERSION
                       "\"\n.SH NAME\ngaussian_splatting \\- train 3D Gaussian splatting models from photos\n"
                       ".SH SYNOPSIS\n";
    for (const command c : all_values<command>)
        text += ".B " + escaped(usage_of(c, rows_of(c, table))) + "\n.br\n";
    text += ".SH COMMANDS\n";
    for (const command c : all_values<command>)
        text += ".TP\n.B " + name_of(c) + "\n" + escaped(purpose_of(c)) + ".\n";
    text += ".SH OPTIONS\nIn names of options, _ and \\- are equal.\n";
    for (const std::string& group : groups_of(table)) {
        text += ".SS " + group + "\n";
        for (const option& row : table)
            if (row.group == group)
                text += ".TP\n.B " + escaped(names_with_type(row)) + "\n" +
                        escaped(description_of(row, row.required == row.commands)) +
                        "\n.br\nCommands: " + commands_of(row) + ".\n";
    }
    return text +
           ".SH EXIT STATUS\n0 on success, 2 after an error, which is printed as one sentence, 3 without "
           "memory, 130 or 143 after Ctrl\\-C or SIGTERM during training.\n";
}

}  // namespace gs::cli
