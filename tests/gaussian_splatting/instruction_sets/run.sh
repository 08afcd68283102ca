#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Passes if a machine without AVX2 or AVX-512 meets none of their instructions before the trainer has asked what the
# machine can do: each engine of the CPU lets nothing of itself be seen but its entry, so that the linker takes none
# of its functions for another's; and nothing else is compiled for more than any x86-64.
#   tests/gaussian_splatting/instruction_sets/run.sh NM OBJDUMP FOLDER_OF_ENGINES OBJECT...    the objects: all else of the program
set -euo pipefail
nm=$1 objdump=$2 engines=$3
shift 3

fail() {
    echo "$1" >&2
    exit 1
}

# expect some|none PATTERN OBJECT...: whether instructions of the objects match. Those of AVX begin with v, those of
# AVX-512 name registers that only it has.
expect() {
    local found is=none
    found=$("$objdump" -d --no-show-raw-insn "${@:3}" | awk -v pattern="$2" '$0 ~ pattern { ++n } END { print n + 0 }')
    ((found == 0)) || is=some
    [[ $is == "$1" ]] || fail "$found instructions like $2, where $1 are due: ${*:3}"
}
avx='^ *[0-9a-f]+:\tv'
avx512='%zmm|%k[0-7]|%[xy]mm(1[6-9]|2[0-9]|3[01])'

# expect_entry OBJECT NAME: whether the function is the only global name of the object.
expect_entry() {
    local seen
    seen=$("$nm" --defined-only --extern-only --format=posix "$1" | cut -d' ' -f1)
    [[ $seen == "$2" ]] || fail "$1 has the global names: $seen"
}
for level in x86_64_v3 x86_64_v4; do
    expect_entry "$engines/cpu_engine_$level.o" "make_cpu_engine_$level"
done
expect_entry "$engines/lpips_x86_64_v3.o" convolve_x86_64_v3
expect some "$avx512" "$engines/cpu_engine_x86_64_v4.o"
expect none "$avx512" "$engines/cpu_engine_x86_64_v3.o"
expect none "$avx512" "$engines/lpips_x86_64_v3.o"
expect some "$avx" "$engines/cpu_engine_x86_64_v3.o"
expect some "$avx" "$engines/lpips_x86_64_v3.o"
(($# > 20)) || fail "these are not all objects of the program: $*"
expect none "$avx" "$@"
