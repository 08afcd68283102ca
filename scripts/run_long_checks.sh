#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# The checks that take too long for .ci/run. Run them before a release, and after changes of numerics,
# densification, benchmarks or the build. They take hours on two cores.
#   scripts/run_long_checks.sh
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh chromium clang doxygen python3-jsonschema python3-numpy python3-skimage python3-torch
cmake --workflow --preset full
# All checks of UndefinedBehaviorSanitizer. The preset leaves out those that double the code.
cmake --preset asan -B build/sanitized -DWARPAGG_SANITIZE=address,undefined
cmake --build build/sanitized --target test_programs
ctest --test-dir build/sanitized --parallel 2 --no-tests=error --output-on-failure -E 'quality: |long: |^example_'
tests/mutation/sweep.py
tests/mutation/hard_cases.py
