// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>

#include "simulator.hpp"

namespace warpagg::emulator {

namespace detail {

/// An index, and the call site that uses it.
struct place {
    template <std::integral I>
    place(I i, call_site site = call_site::here("[]"))  // NOLINT: implicit, as `a[i]` converts i to it
        : index(static_cast<std::size_t>(i)), at(site) {}
    std::size_t index;
    call_site at;
};

}  // namespace detail

/// A watched array: the simulator sees its accesses, so ordinary code (`a[i] = b[j]`) is checked for
/// races. Write the kernel as a template over the types of its arrays, and pass a pointer on CUDA and
/// a watched array in tests. Outside kernels it works as a span. It does not check bounds;
/// AddressSanitizer does. Precondition: `T` is trivially copyable.
template <class T>
class watched {
  public:
    /// The type of an element.
    using value_type = std::remove_const_t<T>;

    /// Watches `size` elements from `first` on.
    watched(T* first, std::size_t size) : first_(first), size_(size) {}
    /// Watches all elements of a vector, an array or a span.
    template <class Range>
    requires requires(Range& r) {
        { std::data(r) } -> std::convertible_to<T*>;
    }
    explicit watched(Range& range) : watched(std::data(range), std::size(range)) {}

    /// A reference to an element. The simulator sees its reads (conversions) and writes (assignments).
    class reference {
      public:
        /// @{
        /// Works as in a `T&`.
        reference(T* to, const call_site& at) : to_(to), at_(at) {}
        operator value_type() const {  // NOLINT: implicit, as for a reference
            if (auto* m = detail::simulator::running())
                m->access_memory(to_, sizeof(T), detail::access_kind::read, at_);
            return *to_;
        }
        const reference& operator=(const value_type& v) const requires(!std::is_const_v<T>) {
            if (auto* m = detail::simulator::running())
                m->write_memory(to_, v, detail::access_kind::write, at_);
            *to_ = v;
            return *this;
        }
        const reference& operator=(const reference& v) const { return *this = static_cast<value_type>(v); }
        reference(const reference&) = default;
        const reference& operator+=(const value_type& v) const {
            return *this = static_cast<value_type>(*this + v);
        }
        const reference& operator-=(const value_type& v) const {
            return *this = static_cast<value_type>(*this - v);
        }
        /// @}

      private:
        T* to_;
        call_site at_;
    };

    /// Returns a reference to element i, an index of any integral type. Precondition: 0 <= i < size().
    reference operator[](detail::place i) const { return {first_ + i.index, i.at}; }
    /// Returns the array itself, for accesses that the simulator does not see.
    T* data() const { return first_; }
    /// Returns the number of elements.
    std::size_t size() const { return size_; }

  private:
    T* first_;
    std::size_t size_;
};

/// Deduces the element type: `watched(vector)` watches the vector's elements.
template <class Range>
watched(Range&) -> watched<std::remove_pointer_t<decltype(std::data(std::declval<Range&>()))>>;

}  // namespace warpagg::emulator
