// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// CUDA's atomics on 32-bit and 64-bit words, and `__ldg`. Each works as in CUDA and returns the value
/// before; the last parameter is the call site.

#include <concepts>

#include "runtime_interface.hpp"

/// @{
/// Works as in CUDA.
template <class T>
T atomicAdd(T* to, std::type_identity_t<T> v, warpagg::call_site at = warpagg::call_site::here("atomicAdd")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T a, T b) { return static_cast<T>(a + b); }, at);
}
template <std::integral T>
T atomicSub(T* to, std::type_identity_t<T> v, warpagg::call_site at = warpagg::call_site::here("atomicSub")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T a, T b) { return static_cast<T>(a - b); }, at);
}
template <std::integral T>
T atomicMin(T* to, std::type_identity_t<T> v, warpagg::call_site at = warpagg::call_site::here("atomicMin")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T a, T b) { return b < a ? b : a; }, at);
}
template <std::integral T>
T atomicMax(T* to, std::type_identity_t<T> v, warpagg::call_site at = warpagg::call_site::here("atomicMax")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T a, T b) { return a < b ? b : a; }, at);
}
template <std::integral T>
T atomicAnd(T* to, std::type_identity_t<T> v, warpagg::call_site at = warpagg::call_site::here("atomicAnd")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T a, T b) { return a & b; }, at);
}
template <std::integral T>
T atomicOr(T* to, std::type_identity_t<T> v, warpagg::call_site at = warpagg::call_site::here("atomicOr")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T a, T b) { return a | b; }, at);
}
template <std::integral T>
T atomicXor(T* to, std::type_identity_t<T> v, warpagg::call_site at = warpagg::call_site::here("atomicXor")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T a, T b) { return a ^ b; }, at);
}
template <class T>
T atomicExch(T* to, std::type_identity_t<T> v,
             warpagg::call_site at = warpagg::call_site::here("atomicExch")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [](T, T b) { return b; }, at);
}
template <std::integral T>
T atomicCAS(T* to, std::type_identity_t<T> expected, std::type_identity_t<T> v,
            warpagg::call_site at = warpagg::call_site::here("atomicCAS")) {
    return warpagg::emulator::detail::runtime::update(
        to, v, [expected](T a, T b) { return a == expected ? b : a; }, at);
}
inline unsigned atomicInc(unsigned* to, unsigned limit,
                          warpagg::call_site at = warpagg::call_site::here("atomicInc")) {
    return warpagg::emulator::detail::runtime::update(
        to, limit, [](unsigned a, unsigned b) { return a >= b ? 0 : a + 1; }, at);
}
inline unsigned atomicDec(unsigned* to, unsigned limit,
                          warpagg::call_site at = warpagg::call_site::here("atomicDec")) {
    return warpagg::emulator::detail::runtime::update(
        to, limit, [](unsigned a, unsigned b) { return a == 0 || a > b ? b : a - 1; }, at);
}
template <class T>
T __ldg(const T* from, warpagg::call_site at = warpagg::call_site::here("__ldg")) {
    return warpagg::emulator::detail::runtime::read(from, at);
}
/// @}
