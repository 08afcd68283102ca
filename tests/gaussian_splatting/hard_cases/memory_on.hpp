// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace hard_cases {

/// To the device's precision. Denormals too: hosts that flush them would not let them through.
template <class Real>
Real to_real(double x) {
    if constexpr (std::is_same_v<Real, float>) {
        if (x != 0 && std::abs(x) < 0x1p-126) {
            const auto bits = static_cast<std::uint32_t>(std::abs(x) * 0x1p149);
            return std::bit_cast<float>(bits | (x < 0 ? 0x80000000u : 0u));
        }
    }
    return static_cast<Real>(x);
}

/// In magnitude, of those that are finite.
inline float largest_of(const std::vector<double>& values) {
    double largest = 0;
    for (const double x : values)
        if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
    return static_cast<float>(largest);
}

/// Carries arrays to a device and back.
template <class Device, class Real>
class memory_on {
  public:
    template <class T>
    using buffer = typename Device::template buffer<T>;

    explicit memory_on(Device& device) : device_(device) {}

    void put(buffer<Real>& to, const std::vector<double>& from) {
        std::vector<Real> host;
        host.reserve(from.size());
        for (const double x : from) host.push_back(to_real<Real>(x));
        put_as_they_are(to, host);
    }
    void put_bytes(buffer<std::uint8_t>& to, const std::vector<std::uint8_t>& from) {
        put_as_they_are(to, from);
    }
    template <class T>
    void put_as_they_are(buffer<T>& to, const std::vector<T>& from) {
        to.resize(from.size());
        if (!from.empty()) device_.upload(to.data(), from.data(), from.size());
        device_.wait();
    }

    std::vector<double> get(const Real* from, std::size_t n) {
        const std::vector<Real> host = get_as_they_are(from, n);
        return {host.begin(), host.end()};
    }
    template <class T>
    std::vector<T> get_as_they_are(const T* from, std::size_t n) {
        std::vector<T> host(n);
        if (n > 0) device_.download(host.data(), from, n);
        return host;
    }

  private:
    Device& device_;
};

}  // namespace hard_cases
