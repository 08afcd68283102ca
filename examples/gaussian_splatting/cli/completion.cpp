// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "completion.hpp"

#include <vector>

#include "../core/error.hpp"
#include "help.hpp"
#include "option_table.hpp"

namespace gs::cli {

namespace {

/// What a shell offers for the value of an option.
enum class offer { nothing, suggestions, folders, files };

offer offer_for(const option& row) {
    if (!row.value.suggestions.empty()) return offer::suggestions;
    if (row.value.type.starts_with("INTEGER") || row.value.type.starts_with("NUMBER")) return offer::nothing;
    return row.value.type == "FOLDER" ? offer::folders : offer::files;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

/// Returns the commands and the options instead of a command.
std::vector<std::string> first_words() {
    std::vector<std::string> words;
    for (const command c : all_values<command>) words.push_back(name_of(c));
    for (const program_option& o : program_options()) words.push_back(o.name);
    return words;
}

std::string bash_offer(const option& row) {
    switch (offer_for(row)) {
        case offer::nothing:
            return "kind=nothing";
        case offer::suggestions:
            return "words='" + joined(row.value.suggestions, " ") + "'";
        case offer::folders:
            return "kind=folders";
        case offer::files:
            return "kind=files";
    }
    return "";
}

/// Returns the branch for a command: what follows `$previous`.
std::string bash_branch(command c, const std::vector<option>& rows) {
    std::string text = "        " + name_of(c) + ")\n            case $previous in\n";
    std::vector<std::string> names{"--help"};
    bool has_positional = false;
    for (const option& row : rows) {
        if (row.is_positional())
            has_positional = true;
        else
            names.push_back(row.name());
        if (!row.is_positional() && !row.value.is_flag())
            text += "                " + joined(row.all_names(), " | ") + ") " + bash_offer(row) + " ;;\n";
    }
    text += "                *) words='" + joined(names, " ") + "'";
    if (has_positional) text += "; [[ $current == -* ]] || kind=files";
    return text + " ;;\n            esac\n            ;;\n";
}

std::string bash_script(const std::vector<option>& table) {
    std::string text = R"(# Completes the command line of gaussian_splatting in bash.
_gaussian_splatting() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local kind=words words=''
    # Bash splits --option=value into three words.
    if [[ $current == '=' ]]; then
        current=''
    elif [[ $previous == '=' ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    local command=${COMP_WORDS[1]}
    ((COMP_CWORD > 1)) || command=''
    case $command in
        '') words=')" + joined(first_words(), " ") +
                       "' ;;\n"
                       "        --print-completion) words='bash zsh' ;;\n";
    for (const command c : all_values<command>) text += bash_branch(c, rows_of(c, table));
    return text + R"(    esac
    COMPREPLY=()
    case $kind in
        words) mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current") ;;
        files) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
        folders) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
    esac
    # Lets readline quote file names and add slashes to folders.
    [[ $kind == words ]] || compopt -o filenames 2>/dev/null
}
complete -F _gaussian_splatting gaussian_splatting
)";
}

/// Returns a word of zsh. `special`: characters that the reader of the word needs escaped.
std::string zsh_word(const std::string& text, const std::string& special = "") {
    std::string word;
    for (const char c : text) {
        if (special.find(c) != std::string::npos) word += '\\';
        word += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return word;
}

std::string zsh_offer(const option& row) {
    switch (offer_for(row)) {
        case offer::nothing:
            return " ";
        case offer::suggestions:
            return "(" + joined(row.value.suggestions, " ") + ")";
        case offer::folders:
            return "_files -/";
        case offer::files:
            return "_files";
    }
    return "";
}

/// Returns the arguments of `_arguments` for an option, one for each of its names.
std::string zsh_arguments(const option& row) {
    const std::string value = ":" + row.value.type + ":" + zsh_offer(row);
    if (row.is_positional()) return " \\\n            '1" + value + "'";
    const std::string prefix = row.value.is_list ? "*" : "(" + joined(row.all_names(), " ") + ")";
    std::string text;
    for (const std::string& name : row.all_names()) {
        text += " \\\n            '" + prefix + name;
        if (!row.value.is_flag()) text += name.starts_with("--") ? "=" : "+";  // --name=value, -nvalue
        text += "[" + zsh_word(row.help, "[]\\:") + "]" + (row.value.is_flag() ? "" : value) + "'";
    }
    return text;
}

std::string zsh_script(const std::vector<option>& table) {
    std::string text =
        "#compdef gaussian_splatting\n"
        "# Completes the command line of gaussian_splatting in zsh.\n"
        "if ((CURRENT == 2)); then\n"
        "    local -a first_words=(\n";
    for (const command c : all_values<command>)
        text += "        '" + zsh_word(name_of(c) + ":" + purpose_of(c)) + "'\n";
    for (const program_option& o : program_options())
        text += "        '" + zsh_word(o.name + ":" + o.help) + "'\n";
    text += R"(    )
    _describe command first_words
    return
fi
local command=$words[2]
shift words
((CURRENT--))
case $command in
    --print-completion) _values shell bash zsh ;;
)";
    for (const command c : all_values<command>) {
        text += "    " + name_of(c) + ")\n        _arguments '--help[Prints the options of the command]'";
        for (const option& row : rows_of(c, table)) text += zsh_arguments(row);
        text += "\n        ;;\n";
    }
    return text + "esac\n";
}

}  // namespace

std::string completion_script(const std::string& shell) {
    settings defaults;
    const std::vector<option> table = option_table(defaults);
    if (shell == "bash") return bash_script(table);
    if (shell == "zsh") return zsh_script(table);
    throw error("--print-completion must be bash or zsh, not '" + shell + "'");
}

}  // namespace gs::cli
