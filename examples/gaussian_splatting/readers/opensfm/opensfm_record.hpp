// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <string_view>

#include "../json_events.hpp"

namespace gs {

/// The fields of a camera, shot or point in `reconstruction.json`, whatever their order. A later
/// field replaces an earlier one of the same name.
class opensfm_record {
  public:
    /// Forgets all fields. Messages begin with `where`.
    void begin(std::string where);

    void set(std::string_view field, const json_value& one);
    void begin_vector(std::string_view field);
    void add_component(std::string_view field, double value);

    // These functions throw `error` if the field is missing or has another type.

    double number(std::string_view field) const;
    double number_or_zero(std::string_view field) const;
    int side(std::string_view field) const;           ///< a whole number from 1 to 65536
    glm::dvec3 vector(std::string_view field) const;  ///< three finite numbers
    const std::string& text(std::string_view field) const;

    const std::string& where() const { return where_; }

  private:
    static constexpr std::array<std::string_view, 13> number_names = {
        "width", "height", "focal", "focal_x", "focal_y", "c_x", "c_y", "k1", "k2", "k3", "k4", "p1", "p2"};
    static constexpr std::array<std::string_view, 4> vector_names = {"rotation", "translation", "coordinates",
                                                                     "color"};
    static constexpr std::array<std::string_view, 2> text_names = {"projection_type", "camera"};

    template <class T>
    struct slot {
        bool exists = false, is_valid = false;
        T value{};
    };
    struct components {
        glm::dvec3 values{0};
        std::size_t count = 0;
    };

    template <class T>
    const T& require(const slot<T>& found, std::string_view field, const char* type) const;

    std::string where_;
    std::array<slot<double>, number_names.size()> numbers_;
    std::array<slot<components>, vector_names.size()> vectors_;
    std::array<slot<std::string>, text_names.size()> texts_;
};

}  // namespace gs
