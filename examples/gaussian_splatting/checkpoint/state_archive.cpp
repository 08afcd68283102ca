// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "state_archive.hpp"

#include <array>
#include <charconv>

#include "../core/error.hpp"

namespace gs {
namespace {

template <class T>
void read(const std::string& name, const std::string& text, T& value) {
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failed != std::errc() || end != text.data() + text.size())
        throw error("the checkpoint has the value '" + text + "' of " + name + ", which is no number");
}

}  // namespace

bool state_archive::has(std::string_view name) const {
    return values_.contains(full_name(name)) || arrays_.contains(full_name(name));
}

const std::string& state_archive::text_of(std::string_view name) const {
    const auto found = values_.find(full_name(name));
    if (found == values_.end()) throw error("the checkpoint has no value of " + full_name(name));
    return found->second;
}

const state_archive::array& state_archive::array_of(std::string_view name, std::size_t element_size) const {
    const auto found = arrays_.find(full_name(name));
    if (found == arrays_.end()) throw error("the checkpoint has no array " + full_name(name));
    if (found->second.bytes.size() % element_size != 0)
        throw error("the checkpoint has an array " + full_name(name) + " of the wrong size");
    return found->second;
}

std::string state_archive::text_of_number(double value) {
    std::array<char, 32> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), result.ptr};
}

void state_archive::read_number(std::string_view name, double& value) const {
    read(full_name(name), text_of(name), value);
}
void state_archive::read_number(std::string_view name, std::int64_t& value) const {
    read(full_name(name), text_of(name), value);
}
void state_archive::read_number(std::string_view name, std::uint64_t& value) const {
    read(full_name(name), text_of(name), value);
}

}  // namespace gs
