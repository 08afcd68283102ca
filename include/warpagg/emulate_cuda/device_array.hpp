// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <type_traits>
#include <utility>

#include "runtime_interface.hpp"

namespace warpagg::emulator {

/// An array that kernels may access. Pass it to a kernel in place of a pointer. The emulator diagnoses
/// accesses outside of it. Precondition: `T` is trivially copyable.
template <class T>
class device_array {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    /// Allocates n elements without values, as cudaMalloc does. The emulator diagnoses reads of elements
    /// that neither a kernel nor `operator[]` has written.
    explicit device_array(std::size_t n)
        : first_(static_cast<T*>(detail::runtime::allocate(n * sizeof(T)))), size_(n) {}
    /// Makes an array of n copies of a value.
    device_array(std::size_t n, const T& value) : device_array(n) {
        std::fill_n(first_, n, value);
        detail::runtime::define(first_, n * sizeof(T));
    }
    /// Copies the values of a vector, an array or a list.
    /// @{
    template <class Range>
    requires requires(const Range& r) {
        { std::data(r) } -> std::convertible_to<const T*>;
    }
    explicit device_array(const Range& values) : device_array(std::size(values)) {
        std::copy_n(std::data(values), size_, first_);
        detail::runtime::define(first_, size_ * sizeof(T));
    }
    device_array(std::initializer_list<T> values) : device_array(std::size(values)) {
        std::copy_n(std::data(values), size_, first_);
        detail::runtime::define(first_, size_ * sizeof(T));
    }
    /// @}
    device_array(const device_array&) = delete;
    device_array& operator=(const device_array&) = delete;
    ~device_array() { detail::runtime::deallocate(first_); }

    /// Returns the pointer that a kernel takes.
    /// @{
    operator T*() { return first_; }
    operator const T*() const { return first_; }
    /// @}

    /// Returns an element, for tests. A test that assigns to it gives it a value.
    /// @{
    T& operator[](std::size_t i) {
        detail::runtime::define(first_ + i, sizeof(T));
        return first_[i];
    }
    const T& operator[](std::size_t i) const { return first_[i]; }
    /// @}
    std::size_t size() const { return size_; }       ///< Number of elements
    const T* begin() const { return first_; }        ///< The first element, for tests
    const T* end() const { return first_ + size_; }  ///< The end of the elements, for tests

  private:
    T* first_;
    std::size_t size_;
};

/// Deduces the element type: `device_array(vector)` copies the vector's elements.
template <class Range>
device_array(const Range&)
    -> device_array<std::remove_cvref_t<decltype(*std::data(std::declval<const Range&>()))>>;

}  // namespace warpagg::emulator
