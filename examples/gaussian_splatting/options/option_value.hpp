// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "enum_names.hpp"

namespace gs::options {

/// The error that an option does not accept a word. `what()` continues a sentence that begins with
/// the option's name.
struct refused_word : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The member that an option sets, and the conversions between text, the member and JSON.
struct option_value {
    std::string type;   ///< placeholder in help texts, such as "INTEGER"; empty for a flag
    std::string range;  ///< the accepted values, such as "1 to 8", or empty
    /// Sets the member from one word; flags receive "true" or "false". Throws `refused_word` for
    /// others.
    std::function<void(const std::string& word)> read;
    std::function<nlohmann::ordered_json()> json;  ///< the member's value; null if unset
    bool is_list = false;                          ///< takes several words; `read` adds one
    std::vector<std::string> suggestions{};        ///< words that shells offer for completion
    std::string implied{};  ///< the word that `read` gets if the user gives none; empty: one is needed

    bool is_flag() const { return type.empty(); }
};

inline constexpr std::uint64_t most_iterations = 10'000'000;

/// Returns the number in a word. Throws `refused_word` if the word is not a number of this kind.
/// @{
std::uint64_t read_whole(const std::string& word, std::uint64_t least, std::uint64_t most);
double read_positive(const std::string& word);
double read_not_negative(const std::string& word);
double read_share(const std::string& word);
/// A size in bytes: a number, which may have a fraction, and a unit of `byte_units`; without a unit,
/// whole bytes.
std::uint64_t read_byte_size(const std::string& word);
/// @}

/// Returns the index of `word` in `names`. Throws `refused_word`, which lists the names, for other
/// words.
std::size_t read_choice(const std::string& word, const std::vector<std::string>& names);
/// Returns a text such as "a, b or c".
std::string alternatives(const std::vector<std::string>& names);

template <class T>
nlohmann::ordered_json json_of(const T& member) {
    return member;
}
template <class T>
nlohmann::ordered_json json_of(const std::optional<T>& member) {
    return member ? nlohmann::ordered_json(*member) : nlohmann::ordered_json(nullptr);
}

template <class T>
T value_in(const T&);
template <class T>
T value_in(const std::optional<T>&);
/// `T` for members of type `T` and of type `std::optional<T>`.
template <class Member>
using value_type = decltype(value_in(std::declval<Member&>()));

/// Returns a value of this kind, which sets `member`. The member must outlive it.
/// @{
option_value text(std::string& member, const std::string& type);
option_value flag(bool& member);
/// Numbers of iterations.
option_value iterations(std::set<int>& member);
/// One of `names`, such as the names of all losses.
option_value word(std::string& member, std::vector<std::string> names);

/// A flag that sets `member` to one value.
template <class Member>
option_value shorthand(Member& member, Member value) {
    return {.type = "",
            .range = "",
            .read =
                [&member, value](const std::string& word) {
                    if (word == "true") member = value;
                },
            .json = [&member] { return json_of(member); }};
}

/// A whole number within the bounds.
template <class Member>
option_value whole(Member& member, std::uint64_t least, std::uint64_t most) {
    return {.type = "INTEGER",
            .range = std::to_string(least) + " to " + std::to_string(most),
            .read =
                [=, &member](const std::string& word) {
                    member = static_cast<value_type<Member>>(read_whole(word, least, most));
                },
            .json = [&member] { return json_of(member); }};
}

/// A whole number from 1 to `most`, or the word all, which sets `member` to 0.
option_value count_or_all(int& member, int most);

/// A positive number that float can hold.
template <class Member>
option_value positive(Member& member) {
    return {.type = "NUMBER",
            .range = "above 0",
            .read = [&member](const std::string& word) { member = read_positive(word); },
            .json = [&member] { return json_of(member); }};
}

/// 0, or a positive number that float can hold.
template <class Member>
option_value not_negative(Member& member) {
    return {.type = "NUMBER",
            .range = "0 or more",
            .read = [&member](const std::string& word) { member = read_not_negative(word); },
            .json = [&member] { return json_of(member); }};
}

/// A number from 0 to below 1.
template <class Member>
option_value share(Member& member) {
    return {.type = "NUMBER",
            .range = "0 to below 1",
            .read = [&member](const std::string& word) { member = read_share(word); },
            .json = [&member] { return json_of(member); }};
}

/// A size in bytes, such as 16GB.
option_value byte_size(std::optional<std::uint64_t>& member);

template <class Enum>
nlohmann::ordered_json json_of_choice(Enum member) {
    return name_of(member);
}
template <class Enum>
nlohmann::ordered_json json_of_choice(std::optional<Enum> member) {
    return member ? nlohmann::ordered_json(name_of(*member)) : nlohmann::ordered_json(nullptr);
}

/// One of the words in `names_of(Enum)`. The member may be optional.
template <class Enum>
option_value choice(Enum& member) {
    const auto known = names_of(value_type<Enum>{});
    const std::vector<std::string> names(known.begin(), known.end());
    return {.type = "WORD",
            .range = alternatives(names),
            .read =
                [=, &member](const std::string& word) {
                    member = static_cast<value_type<Enum>>(read_choice(word, names));
                },
            .json = [&member] { return json_of_choice(member); },
            .suggestions = names};
}
/// @}

}  // namespace gs::options
