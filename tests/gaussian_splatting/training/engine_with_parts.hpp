// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "device/cpu/cpu.hpp"
#include "engine/engine.hpp"
#include "training/engine_parts.hpp"

/// An engine on the CPU that creates its loss and its strategy by these functions. It is compiled once for
/// all tests that need one.
std::unique_ptr<gs::train::engine> make_engine_with(gs::train::engine_parts<gs::device::cpu> parts);
