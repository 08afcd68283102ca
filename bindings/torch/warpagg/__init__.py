# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Warp-aggregated atomics: see `warpagg.torch`."""
