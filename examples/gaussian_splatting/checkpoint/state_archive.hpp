// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace gs {

/// The state of a training run between memory and a checkpoint file: values and arrays by name.
///
/// A class with state has one function that passes each member to `exchange`. An archive that saves
/// copies the member; one that loads replaces it. Names are relative to the enclosing `scope`.
class state_archive {
  public:
    /// A value as text, which represents numbers exactly.
    using value_map = std::map<std::string, std::string>;
    struct array {
        std::string element;  ///< type of the elements in the terms of safetensors, such as "F32"
        std::vector<std::byte> bytes;
    };
    using array_map = std::map<std::string, array>;

    /// Creates an empty archive that saves.
    state_archive() = default;
    /// Creates an archive that loads these values and arrays.
    state_archive(value_map values, array_map arrays)
        : values_(std::move(values)), arrays_(std::move(arrays)), loads_(true) {}

    bool loads() const { return loads_; }
    /// Returns whether a value or an array of this name exists.
    bool has(std::string_view name) const;

    /// Saves or loads a value: a bool, a number or a text. Throws `error` if an archive that loads
    /// has no such value.
    template <class T>
    void exchange(std::string_view name, T& value);
    /// Saves or loads an array of trivially copyable elements. Throws `error` if an archive that
    /// loads has no such array.
    template <class T>
    void exchange(std::string_view name, std::vector<T>& elements);

    /// Prefixes names with `name` and a dot while it exists.
    class scope {
      public:
        scope(state_archive& archive, std::string_view name) : archive_(archive), outer_(archive.prefix_) {
            archive.prefix_ += std::string(name) + ".";
        }
        scope(const scope&) = delete;
        scope& operator=(const scope&) = delete;
        ~scope() { archive_.prefix_ = outer_; }

      private:
        state_archive& archive_;
        std::string outer_;
    };

    const value_map& values() const { return values_; }
    const array_map& arrays() const { return arrays_; }

  private:
    const std::string& text_of(std::string_view name) const;
    const array& array_of(std::string_view name, const std::string& element, std::size_t size) const;
    /// Throws `error` for a value or an array that this program cannot have written.
    [[noreturn]] void refuse(std::string_view name, const std::string& found) const;
    std::string full_name(std::string_view name) const { return prefix_ + std::string(name); }

    static std::string text_of_number(double value);
    static std::string text_of_number(std::int64_t value) { return std::to_string(value); }
    static std::string text_of_number(std::uint64_t value) { return std::to_string(value); }
    void read_number(std::string_view name, double& value) const;
    void read_number(std::string_view name, std::int64_t& value) const;
    void read_number(std::string_view name, std::uint64_t& value) const;

    /// The widest type of the same kind as T.
    template <class T>
    using widest = std::conditional_t<std::is_floating_point_v<T>, double,
                                      std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>>;
    template <class T>
    static constexpr const char* element_name() {
        if constexpr (std::same_as<T, float>) return "F32";
        if constexpr (std::same_as<T, double>) return "F64";
        if constexpr (std::same_as<T, std::int32_t>) return "I32";
        if constexpr (std::same_as<T, std::uint32_t>) return "U32";
        if constexpr (std::same_as<T, std::uint64_t>) return "U64";
        return "U8";  // the bytes of other types
    }

    value_map values_;
    array_map arrays_;
    bool loads_ = false;
    std::string prefix_;
};

template <class T>
void state_archive::exchange(std::string_view name, T& value) {
    if constexpr (std::same_as<T, std::string>) {
        if (loads_) {
            value = text_of(name);
        } else {
            values_[full_name(name)] = value;
        }
    } else {
        static_assert(std::is_arithmetic_v<T>, "a value is a bool, a number or a text");
        if (loads_) {
            widest<T> read{};
            read_number(name, read);
            if constexpr (std::is_integral_v<T> && !std::same_as<T, bool>)
                if (!std::in_range<T>(read)) refuse(name, "a number out of range");
            value = static_cast<T>(read);
        } else {
            values_[full_name(name)] = text_of_number(static_cast<widest<T>>(value));
        }
    }
}

template <class T>
void state_archive::exchange(std::string_view name, std::vector<T>& elements) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (loads_) {
        const array& saved = array_of(name, element_name<T>(), sizeof(T));
        elements.resize(saved.bytes.size() / sizeof(T));
        if (!elements.empty()) std::memcpy(elements.data(), saved.bytes.data(), saved.bytes.size());
    } else {
        array saved{element_name<T>(), std::vector<std::byte>(elements.size() * sizeof(T))};
        if (!elements.empty()) std::memcpy(saved.bytes.data(), elements.data(), saved.bytes.size());
        arrays_[full_name(name)] = std::move(saved);
    }
}

/// A part of a training run whose state checkpoints contain.
class checkpointed {
  public:
    virtual ~checkpointed() = default;
    /// Passes the state to the archive: see `state_archive`. May wait for the device.
    virtual void exchange(state_archive& archive) = 0;
};

}  // namespace gs
