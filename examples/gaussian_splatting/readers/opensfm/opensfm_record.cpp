// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "opensfm_record.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../core/error.hpp"

namespace gs {
namespace {

/// Returns the slot of a field, or null if the name is not among `names`.
auto* find_slot(auto& slots, const auto& names, std::string_view field) {
    const auto found = std::ranges::find(names, field);
    return found == names.end() ? nullptr : &slots[static_cast<std::size_t>(found - names.begin())];
}

}  // namespace

void opensfm_record::begin(std::string where) {
    *this = {};
    where_ = std::move(where);
}

void opensfm_record::set(std::string_view field, const json_value& one) {
    if (auto* number = find_slot(numbers_, number_names, field))
        *number = {true, std::isfinite(one.number), one.number};
    if (auto* text = find_slot(texts_, text_names, field))
        *text = {true, one.text != nullptr, one.text ? *one.text : std::string()};
    if (auto* vector = find_slot(vectors_, vector_names, field)) *vector = {true, false, {}};
}

void opensfm_record::begin_vector(std::string_view field) {
    set(field, {});
    if (auto* vector = find_slot(vectors_, vector_names, field)) vector->is_valid = true;
}

void opensfm_record::add_component(std::string_view field, double value) {
    auto* vector = find_slot(vectors_, vector_names, field);
    if (!vector) return;
    auto& [values, count] = vector->value;
    vector->is_valid &= std::isfinite(value) && count < 3;
    if (vector->is_valid) values[static_cast<glm::length_t>(count++)] = value;
}

template <class T>
const T& opensfm_record::require(const slot<T>& found, std::string_view field, const char* type) const {
    if (!found.exists) throw error(where_ + ": the field " + std::string(field) + " is missing");
    if (!found.is_valid) throw error(where_ + ": " + std::string(field) + " is not " + type);
    return found.value;
}

double opensfm_record::number(std::string_view field) const {
    return require(*find_slot(numbers_, number_names, field), field, "a finite number");
}

double opensfm_record::number_or_zero(std::string_view field) const {
    return find_slot(numbers_, number_names, field)->exists ? number(field) : 0;
}

int opensfm_record::side(std::string_view field) const {
    const double value = number(field);
    if (!(value >= 1 && value <= 65536) || value != std::floor(value))
        throw error(where_ + ": " + std::string(field) + " is " + std::to_string(value) +
                    ", but must be a whole number from 1 to 65536");
    return static_cast<int>(value);
}

glm::dvec3 opensfm_record::vector(std::string_view field) const {
    constexpr const char* type = "three finite numbers";
    const auto& found = *find_slot(vectors_, vector_names, field);
    const components& all = require(found, field, type);
    if (all.count < 3) throw error(where_ + ": " + std::string(field) + " is not " + type);
    return all.values;
}

const std::string& opensfm_record::text(std::string_view field) const {
    return require(*find_slot(texts_, text_names, field), field, "a string");
}

}  // namespace gs
