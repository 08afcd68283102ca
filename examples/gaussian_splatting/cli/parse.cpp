// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "parse.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "../core/error.hpp"
#include "apply_quality_preset.hpp"
#include "check_settings.hpp"
#include "completion.hpp"
#include "config_file.hpp"
#include "help.hpp"
#include "nearest_word.hpp"
#include "option_table.hpp"

namespace gs::cli {

namespace {

using options::alternatives;
using options::refused_word;
using words = std::vector<std::string>;

bool contains(const words& all, const std::string& word) { return std::ranges::find(all, word) != all.end(); }

[[noreturn]] void print_and_exit(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::exit(0);
}

/// Replaces `_` by `-` in the name of an option, because both are accepted.
void write_dashes(std::string& word) {
    if (!word.starts_with("--")) return;
    const auto end = static_cast<std::ptrdiff_t>(std::min(word.find('='), word.size()));
    std::replace(word.begin(), word.begin() + end, '_', '-');
}

/// Returns the command that the first word names. For an option in place of a command, prints its
/// text and exits.
command command_named(const words& given) {
    const auto names = names_of(command{});
    const std::string known = alternatives({names.begin(), names.end()});
    if (given.empty()) throw error("a command is missing: give " + known + " (see --help)");
    const std::string& first = given.front();
    if (first == "--help" || first == "-h") print_and_exit(overview());
    if (first == "--version") print_and_exit(WARPAGG_VERSION "\n");
    if (first == "--print-reference") print_and_exit(reference_page());
    if (first == "--print-man-page") print_and_exit(man_page());
    if (first == "--print-completion") print_and_exit(completion_script(given.size() > 1 ? given[1] : ""));
    const auto found = std::ranges::find(names, first);
    if (found == names.end())
        throw error("the command comes first, and '" + first + "' is none: give " + known + " (see --help)");
    return static_cast<command>(found - names.begin());
}

/// The options of one command, and the words that the user gives for each of them.
class command_options {
  public:
    command_options(command c, const std::vector<option>& table) : command_(c), rows_(rows_of(c, table)) {}

    const std::vector<option>& rows() const { return rows_; }
    bool is_explicit(const std::string& name) const { return parsed_.contains(name); }
    /// Returns the values of the given options by `option::key`, as `read_config` reads them. Leaves
    /// out options that are about one run only, such as --resume.
    nlohmann::ordered_json given() const {
        auto all = nlohmann::ordered_json::object();
        for (const option& row : rows_) {
            if (!is_explicit(row.name())) continue;
            const nlohmann::ordered_json value = row.value.json();
            const bool is_shorthand = row.value.is_flag() && !value.is_boolean();
            if (is_shorthand) {
                all[row.key()] = true;
            } else if (row.is_recorded) {
                all[row.key()] = value;
            }
        }
        return all;
    }

    /// Sets the values. Throws `error` for words that do not belong to an option of the command.
    void read(const words& given) {
        check_names(given);
        split(given);
        add_config();
        for (const option& row : rows_)
            if (is_explicit(row.name())) read_row(row);
        for (const option& row : rows_) check_constraints(row);
    }

  private:
    /// Checks names before CLI11 does, whose message would not name the nearest known option.
    void check_names(const words& given) const {
        bool is_value = false;  // of the option before it, such as "-y" in "--up -y"
        for (const std::string& word : given) {
            const bool is_long = word.starts_with("--");
            const bool is_short = !is_long && word.size() > 1 && word[0] == '-' &&
                                  std::isalpha(static_cast<unsigned char>(word[1])) != 0;
            const bool is_name = is_long || (is_short && !is_value);
            is_value = false;
            if (word == "--" || !is_name) continue;
            const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
            const auto row =
                std::ranges::find_if(rows_, [&](const option& o) { return contains(o.all_names(), name); });
            if (row == rows_.end()) refuse_unknown(name);
            if (row->value.is_flag() && name != word && is_long)
                throw error(name + " takes no value: write " + name + " instead of " + word);
            is_value = name == word && std::ranges::any_of(row->value.suggestions, [](const std::string& s) {
                           return s.starts_with('-');
                       });
        }
    }

    [[noreturn]] void refuse_unknown(const std::string& name) const {
        if (rows_.empty()) throw error(name_of(command_) + " takes no options: leave out " + name);
        words known;
        for (const option& row : rows_) std::ranges::copy(row.all_names(), std::back_inserter(known));
        throw error("unknown option " + name + " of " + name_of(command_) + "; the nearest known one is " +
                    nearest_word(name, known));
    }

    /// Assigns the words to options with CLI11.
    void split(const words& given) {
        CLI::App app;
        app.set_help_flag();
        app.allow_extras();
        const auto positional = std::ranges::count_if(rows_, &option::is_positional);
        for (const option& row : rows_) {
            if (row.value.is_flag()) {
                app.add_flag(row.names);
                continue;
            }
            CLI::Option* added = app.add_option(row.names);
            // Several positional options share the words; one gets all, so that a second is noticed.
            const bool gets_one = row.is_positional() && positional > 1;
            added->expected(1, gets_one ? 1 : CLI::detail::expected_max_vector_size);
            added->allow_extra_args(row.value.is_list);
            if (!row.value.implied.empty()) added->expected(0, 1)->default_str(row.value.implied);
        }
        try {
            app.parse(words(given.rbegin(), given.rend()));  // CLI11 expects reverse order
        } catch (const CLI::ArgumentMismatch& missing) {
            const std::string text = missing.what();
            throw error(text.substr(0, text.find(':')) + " needs a value (see --help)");
        }
        for (const option& row : rows_) {
            const CLI::Option* found = app.get_option(row.name());
            if (found->count() > 0) parsed_[row.name()] = found->results();
        }
        if (!app.remaining().empty())
            throw error("the word '" + app.remaining().front() + "' belongs to no option of " +
                        name_of(command_) + " (see --help)");
    }

    /// Adds the options of the file of --config that the command line neither gives nor excludes.
    void add_config() {
        const auto file = parsed_.find(config_option);
        if (file == parsed_.end()) return;
        const auto in_file = read_config(file->second.front(), rows_);
        const auto on_command_line = parsed_;
        for (const option& row : rows_) {
            const auto given = in_file.find(row.name());
            if (given == in_file.end() || is_excluded_by(on_command_line, row)) continue;
            parsed_.emplace(row.name(), given->second);
        }
    }

    bool is_excluded_by(const std::map<std::string, words>& given, const option& row) const {
        return std::ranges::any_of(rows_, [&](const option& other) {
            return given.contains(other.name()) &&
                   (contains(other.excludes, row.name()) || contains(row.excludes, other.name()));
        });
    }

    void read_row(const option& row) const {
        const words& given = parsed_.at(row.name());
        if (given.size() > 1 && !row.value.is_list && !row.value.is_flag())
            throw error(row.name() + " is given " + std::to_string(given.size()) + " times: give it once");
        try {
            std::ranges::for_each(given, row.value.read);
        } catch (const refused_word& wrong) {
            throw error(row.name() + " " + wrong.what());
        }
    }

    void check_constraints(const option& row) const {
        const std::string name = row.name();
        if (!is_explicit(name)) {
            if (row.is_required_by(command_))
                throw error(name_of(command_) + " needs " + name + " " + row.value.type + " (see --help)");
            return;
        }
        for (const std::string& needed : row.needs)
            if (!is_explicit(needed))
                throw error(name + " needs " + needed + ": add " + needed + " or leave out " + name);
        for (const std::string& other : row.excludes)
            if (is_explicit(other))
                throw error(name + " and " + other + " exclude each other: leave out one of them");
    }

    command command_;
    std::vector<option> rows_;
    std::map<std::string, words> parsed_;  ///< words of the given options, by `option::name`
};

}  // namespace

settings parse(words given) {
    settings s;
    std::ranges::for_each(given, write_dashes);
    s.command = command_named(given);
    given.erase(given.begin());
    command_options options(s.command, option_table(s));
    if (contains(given, "--help") || contains(given, "-h"))
        print_and_exit(help_text(s.command, options.rows()));
    options.read(given);
    s.given = options.given();
    for (const option& row : options.rows())
        if (options.is_explicit(row.name())) check_belongs_to_strategy(row, s.densification.name);
    apply_quality_preset(s.quality, options.rows(),
                         [&](const std::string& name) { return options.is_explicit(name); });
    set_dependent_values(s);
    check_settings(s);
    return s;
}

}  // namespace gs::cli
