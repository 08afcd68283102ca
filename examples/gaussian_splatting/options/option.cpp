// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "option.hpp"

#include <algorithm>
#include <sstream>

namespace gs::options {

namespace {

bool contains(const std::vector<command>& commands, command c) {
    return std::ranges::find(commands, c) != commands.end();
}

}  // namespace

bool option::belongs_to(command c) const { return contains(commands, c); }
bool option::is_required_by(command c) const { return contains(required, c); }
bool option::is_positional() const { return !name().starts_with('-'); }

std::vector<std::string> option::all_names() const {
    std::vector<std::string> all;
    std::istringstream list(names);
    for (std::string name; std::getline(list, name, ',');) all.push_back(name.substr(name[0] == '!' ? 1 : 0));
    return all;
}

std::string option::name() const {
    const auto all = all_names();
    const auto is_long = [](const std::string& name) { return name.starts_with("--"); };
    const auto found = std::ranges::find_if(all, is_long);
    return found == all.end() ? all.front() : *found;
}

std::string option::key() const {
    std::string key = name();
    key.erase(0, key.find_first_not_of('-'));
    std::ranges::replace(key, '-', '_');
    return key;
}

}  // namespace gs::options
