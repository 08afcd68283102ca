# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
include(${CMAKE_CURRENT_LIST_DIR}/warpagg-targets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/emulate_cuda.cmake)
