// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "option_value.hpp"

namespace gs::options {

/// A row of the option table: an option of the program, and the value that it sets.
struct option {
    std::string names;    ///< names, separated by commas; `!` marks a name that turns a flag off
    std::string group{};  ///< heading in help texts
    std::vector<command> commands{};
    option_value value;
    std::string help;  ///< a sentence without its period; begins with a noun or a verb
    std::string unit{};
    std::string default_text{};        ///< the default in words, if it depends on other settings
    std::vector<command> required{};   ///< the commands that require the option
    std::vector<std::string> needs{};  ///< names of options that must be given with it
    std::vector<std::string> excludes{};
    std::string strategy{};   ///< the densification strategy that has the option, or empty
    bool is_rare = false;     ///< help texts list only its name; the reference describes it
    bool is_recorded = true;  ///< in settings.json; false if another option has the same member

    bool belongs_to(command c) const;
    bool is_required_by(command c) const;
    bool is_positional() const;
    /// Returns the names as users type them, in the order of `names`.
    std::vector<std::string> all_names() const;
    /// Returns the first long name, such as "--sh-degree". Messages and other rows use it.
    std::string name() const;
    /// Returns the name in settings.json, such as "sh_degree".
    std::string key() const;
};

}  // namespace gs::options
