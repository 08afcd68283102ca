// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdlib>
#include <set>
#include <sstream>
#include <string>

#include "cli/completion.hpp"
#include "cli/help.hpp"
#include "cli/option_table.hpp"
#include "run_program.hpp"

using namespace gs_test;
using offers = std::set<std::string>;

namespace {

std::string quoted(const std::string& word) { return "'" + word + "'"; }

/// Runs a script in the folder, and returns the lines that it prints.
offers lines_of(const std::string& shell, const std::string& script, const fs::path& folder) {
    const temporary_folder scratch;
    write_file(scratch / "script", script);
    const fs::path out = scratch / "out";
    const std::string command =
        "cd " + quoted(folder) + " && " + shell + " " + quoted(scratch / "script") + " >" + quoted(out);
    REQUIRE(std::system(command.c_str()) == 0);
    std::istringstream text(read_file(out));
    offers lines;
    for (std::string line; std::getline(text, line);) lines.insert(line);
    return lines;
}

/// Returns what bash offers for the last of these words, in a folder with a file and a subfolder.
offers bash_offers(const words& line) {
    const temporary_folder folder;
    write_file(folder / "a file.ply", "");
    fs::create_directory(folder / "a folder");
    std::string script = gs::cli::completion_script("bash") + "COMP_WORDS=(gaussian_splatting";
    for (const std::string& word : line) script += " " + quoted(word);
    script += ")\nCOMP_CWORD=" + std::to_string(line.size()) + "\n_gaussian_splatting\n" +
              "((${#COMPREPLY[@]} == 0)) || printf '%s\\n' \"${COMPREPLY[@]}\"\n";
    return lines_of("bash", script, folder.path());
}

bool has_zsh() { return std::system("zsh -c true 2>/dev/null") == 0; }

}  // namespace

TEST_CASE("completion in bash: the first word is a command or an option instead of one") {
    CHECK(bash_offers({"tr"}) == offers{"train"});
    CHECK(bash_offers({"--v"}) == offers{"--version"});
    offers all;
    for (const auto c : gs::cli::all_values<gs::cli::command>) all.insert(name_of(c));
    for (const auto& o : gs::cli::program_options()) all.insert(o.name);
    CHECK(bash_offers({""}) == all);
    CHECK(bash_offers({"--print-completion", ""}) == offers{"bash", "zsh"});
}

TEST_CASE("completion in bash: each command completes its own options") {
    CHECK(bash_offers({"train", "--ite"}) == offers{"--iterations"});
    CHECK(bash_offers({"render", "--ite"}).empty());
    CHECK(bash_offers({"render", "--orb"}) == offers{"--orbit", "--orbit-views"});
    CHECK(bash_offers({"train", "-d", "a folder", "--eval", "--qui"}) == offers{"--quiet"});
    gs::cli::settings defaults;
    for (const auto c : gs::cli::all_values<gs::cli::command>) {
        offers names{"--help"};
        for (const auto& row : gs::cli::rows_of(c, gs::cli::option_table(defaults)))
            if (!row.is_positional()) names.insert(row.name());
        CHECK(bash_offers({name_of(c), "-"}) == names);
    }
}

TEST_CASE("completion in bash: values of an option are its words, folders or files") {
    CHECK(bash_offers({"train", "--quality", "b"}) == offers{"balanced", "best"});
    CHECK(bash_offers({"train", "--quality", "=", "f"}) == offers{"fast"});
    CHECK(bash_offers({"train", "--device", "="}) == offers{"auto", "cpu", "cuda"});
    CHECK(bash_offers({"train", "-o", ""}) == offers{"a folder"});
    CHECK(bash_offers({"train", "--model-path", "a"}) == offers{"a folder"});
    CHECK(bash_offers({"train", "--data", ""}) == offers{"a file.ply", "a folder"});
    CHECK(bash_offers({"train", "--iterations", ""}).empty());
}

TEST_CASE("completion in bash: a model is a file") {
    CHECK(bash_offers({"render", "a"}) == offers{"a file.ply", "a folder"});
    CHECK(bash_offers({"evaluate", "a file.ply", "--da"}) == offers{"--data"});
}

TEST_CASE("completion in zsh: the script is valid and describes each option once per name") {
    if (!has_zsh()) {
        MESSAGE("skipped: zsh is not installed");
        return;
    }
    const temporary_folder folder;
    const std::string script = gs::cli::completion_script("zsh");
    CHECK(lines_of("zsh -n", script, folder.path()).empty());
    // Prints the arguments that zsh's completion system would get.
    const std::string printed =
        "_arguments() { print -rl -- \"$@\" }\nwords=(gaussian_splatting train '')\n"
        "CURRENT=3\nf() {\n" +
        script + "}\nf\n";
    const offers arguments = lines_of("zsh -f", printed, folder.path());
    gs::cli::settings defaults;
    std::size_t names = 1;  // --help
    for (const auto& row : gs::cli::rows_of(gs::cli::command::train, gs::cli::option_table(defaults)))
        names += row.all_names().size();
    CHECK(arguments.size() == names);
    CHECK(
        arguments.contains("(--loss)--loss=[Measure of the difference between a render and its photo that "
                           "training minimizes]:WORD:(l1_ssim)"));
}

TEST_CASE("completion for an unknown shell is refused") {
    check_refusal({"--print-completion", "fish"}, {"--print-completion", "bash or zsh", "fish"});
    check_refusal({"--print-completion"}, {"bash or zsh"});
}
