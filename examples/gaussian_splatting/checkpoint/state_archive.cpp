// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "state_archive.hpp"

#include <array>
#include <charconv>

#include "../core/error.hpp"

namespace gs {
namespace {

template <class T>
bool read(const std::string& text, T& value) {
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
    return failed == std::errc() && end == text.data() + text.size();
}

}  // namespace

void state_archive::refuse(std::string_view name, const std::string& found) const {
    throw error(
        "the checkpoint has " + found + " for " + full_name(name) +
        ", so another version of this program wrote it: give --overwrite to train from the beginning");
}

bool state_archive::has(std::string_view name) const {
    return values_.contains(full_name(name)) || arrays_.contains(full_name(name));
}

const std::string& state_archive::text_of(std::string_view name) const {
    const auto found = values_.find(full_name(name));
    if (found == values_.end()) refuse(name, "no value");
    return found->second;
}

const state_archive::array& state_archive::array_of(std::string_view name, const std::string& element,
                                                    std::size_t size) const {
    const auto found = arrays_.find(full_name(name));
    if (found == arrays_.end()) refuse(name, "no array");
    if (found->second.element != element || found->second.bytes.size() % size != 0)
        refuse(name, "an array of the wrong type");
    return found->second;
}

std::string state_archive::text_of_number(double value) {
    std::array<char, 32> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), result.ptr};
}

void state_archive::read_number(std::string_view name, double& value) const {
    if (!read(text_of(name), value)) refuse(name, "no number");
}
void state_archive::read_number(std::string_view name, std::int64_t& value) const {
    if (!read(text_of(name), value)) refuse(name, "no number");
}
void state_archive::read_number(std::string_view name, std::uint64_t& value) const {
    if (!read(text_of(name), value)) refuse(name, "no number");
}

}  // namespace gs
