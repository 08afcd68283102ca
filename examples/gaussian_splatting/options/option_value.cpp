// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "option_value.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "../core/byte_size.hpp"
#include "../core/enumerated.hpp"

namespace gs::options {

namespace {

/// Returns the number that `word` consists of, or nothing if it is not a number.
template <class Number>
std::optional<Number> number_in(const std::string& word) {
    Number value{};
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (problem != std::errc() || end != word.data() + word.size()) return {};
    return value;
}

}  // namespace

std::uint64_t read_whole(const std::string& word, std::uint64_t least, std::uint64_t most) {
    const auto value = number_in<std::uint64_t>(word);
    if (!value || *value < least || *value > most)
        throw refused_word("must be a whole number from " + std::to_string(least) + " to " +
                           std::to_string(most) + ", not '" + word + "'");
    return *value;
}

double read_positive(const std::string& word) {
    const auto value = number_in<double>(word);
    const float rounded = static_cast<float>(value.value_or(0));
    if (!value || !std::isfinite(rounded) || !(rounded > 0))
        throw refused_word("must be a positive number that float can hold, not '" + word + "'");
    return *value;
}

double read_not_negative(const std::string& word) {
    const auto value = number_in<double>(word);
    const float rounded = static_cast<float>(value.value_or(0));
    if (!value || !std::isfinite(rounded) || !(*value >= 0))
        throw refused_word("must be 0 or a positive number that float can hold, not '" + word + "'");
    return *value;
}

double read_share(const std::string& word) {
    const auto value = number_in<double>(word);
    if (!value || !(*value >= 0 && *value < 1))
        throw refused_word("must be a number from 0 to below 1, not '" + word + "'");
    return *value;
}

std::uint64_t read_byte_size(const std::string& word) {
    const std::size_t digits = std::min(word.find_first_not_of("0123456789."), word.size());
    const std::string_view unit = std::string_view(word).substr(digits);
    const auto found =
        std::ranges::find(byte_units, unit.empty() ? "B" : unit, &decltype(byte_units)::value_type::first);
    const auto number = number_in<double>(word.substr(0, digits));
    constexpr double most = 1e18;
    if (found == byte_units.end() || !number || !(*number > 0) ||
        !(*number * static_cast<double>(found->second) <= most))
        throw refused_word("must be a size such as 16GB or 500MB, not '" + word + "'");
    return static_cast<std::uint64_t>(*number * static_cast<double>(found->second));
}

std::size_t read_choice(const std::string& word, const std::vector<std::string>& names) {
    const auto found = std::ranges::find(names, word);
    if (found == names.end()) throw refused_word("must be " + alternatives(names) + ", not '" + word + "'");
    return static_cast<std::size_t>(found - names.begin());
}

std::string alternatives(const std::vector<std::string>& names) { return enumerated(names, " or "); }

option_value count_or_all(int& member, int most) {
    return {.type = "INTEGER",
            .range = "1 to " + std::to_string(most) + ", or all",
            .read =
                [=, &member](const std::string& word) {
                    if (word == "all") {
                        member = 0;
                        return;
                    }
                    const auto number = number_in<int>(word);
                    if (!number || *number < 1 || *number > most)
                        throw refused_word("must be a whole number from 1 to " + std::to_string(most) +
                                           ", or all, not '" + word + "'");
                    member = *number;
                },
            .json = [&member] { return member == 0 ? json_of(std::string("all")) : json_of(member); },
            .suggestions = {"all"}};
}

option_value text(std::string& member, const std::string& type) {
    return {.type = type,
            .range = "",
            .read = [&member](const std::string& word) { member = word; },
            .json = [&member] { return json_of(member); }};
}

option_value flag(bool& member) {
    return {.type = "",
            .range = "",
            .read = [&member](const std::string& word) { member = word == "true"; },
            .json = [&member] { return json_of(member); }};
}

option_value iterations(std::set<int>& member) {
    return {.type = "INTEGER...",
            .range = "1 to the number of iterations",
            .read =
                [&member](const std::string& word) {
                    member.insert(static_cast<int>(read_whole(word, 1, most_iterations)));
                },
            .json = [&member] { return json_of(member); },
            .is_list = true};
}

option_value byte_size(std::optional<std::uint64_t>& member) {
    return {.type = "SIZE",
            .range = "such as 16GB or 500MB",
            .read = [&member](const std::string& word) { member = read_byte_size(word); },
            .json = [&member] { return json_of(member); }};
}

option_value word(std::string& member, std::vector<std::string> names) {
    return {.type = "WORD",
            .range = alternatives(names),
            .read = [names, &member](const std::string& word) { member = names[read_choice(word, names)]; },
            .json = [&member] { return json_of(member); },
            .suggestions = names};
}

}  // namespace gs::options
