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

/// An index and the place where it is used.
struct place {
    template <std::integral I>
    place(I i, call_site site = call_site::here("[]"))  // NOLINT: implicit, as `a[i]` converts i to it
        : index(static_cast<std::size_t>(i)), at(site) {}
    std::size_t index;
    call_site at;
};

}  // namespace detail

/// An array whose accesses the simulator sees, so that ordinary code (`a[i] = b[j]`) is checked for
/// races: in place of a pointer, which a kernel that is a template over its arrays' types takes on
/// CUDA. `T` is trivially copyable. Outside of a kernel it is an ordinary span. Does not check
/// bounds; address sanitizer does.
template <class T>
class watched {
  public:
    /// The type of an element.
    using value_type = std::remove_const_t<T>;

    /// `size` elements from `first` on.
    watched(T* first, std::size_t size) : first_(first), size_(size) {}
    /// All elements of a vector, an array or a span.
    template <class Range>
    requires requires(Range& r) {
        { std::data(r) } -> std::convertible_to<T*>;
    }
    explicit watched(Range& range) : watched(std::data(range), std::size(range)) {}

    /// An element; the simulator sees its reads (conversions) and writes (assignments).
    class reference {
      public:
        /// @{
        /// As for a `T&`.
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

    /// Element i, of any integral type; i < size().
    reference operator[](detail::place i) const { return {first_ + i.index, i.at}; }
    /// The array itself, for accesses that the simulator does not see.
    T* data() const { return first_; }
    /// The number of elements.
    std::size_t size() const { return size_; }

  private:
    T* first_;
    std::size_t size_;
};

/// `watched(vector)` watches the vector's elements.
template <class Range>
watched(Range&) -> watched<std::remove_pointer_t<decltype(std::data(std::declval<Range&>()))>>;

}  // namespace warpagg::emulator
