#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Passes if every public header compiles, alone and included twice, without a warning; and all of them together by
# every compiler and standard.
#   tests/packaging/headers/run.sh host    by every GCC from 12 on and every clang that is installed
#   tests/packaging/headers/run.sh NVCC    by that nvcc
set -euo pipefail
cd "$(dirname "$0")/../../../include/warpagg"
export LC_ALL=C

# Those that only nvcc takes, as they call CUDA's intrinsics; and those that it does not, as they are for the host.
nvcc_only=(warp/cuda.hpp warp/cuda_atomics.hpp simt/cuda.hpp reduce/cooperative.hpp reduce/cub.hpp)
host_only=(warp/fork_shadow_process.hpp warp/simd_value.hpp warp/simd.hpp simt/simd.hpp simt/lanes.hpp simt/checked.hpp 'warp/checked.*')
# Those for CUDA kernels on the emulator, which need a compiler option. They declare CUDA's names.
emulate_cuda=(emulate_cuda.hpp 'emulate_cuda/.*')

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

headers_but() {
    find . -name '*.hpp' -printf '%P\n' | sort | grep -vxE "$(printf '%s\n' "$@")"
}

# One translation unit with each header twice, and one with all of them.
write_units() {
    local header
    for header in "$@"; do
        printf '#include <warpagg/%s>\n' "$header" "$header" >"$work/${header//\//_}.$suffix"
    done
    printf '#include <warpagg/%s>\n' "$@" >"$work/all.$suffix"
}

# Command lines, one compilation each, run side by side; the first that fails says which.
compile_all() {
    xargs -P "$(nproc)" -d '\n' -n 1 bash -c '$0 || { echo "fails: $0" >&2; exit 255; }'
}

if [[ ${1:?host or an nvcc} == host ]]; then
    suffix=cpp
    mapfile -t headers < <(headers_but "${nvcc_only[@]}" "${emulate_cuda[@]}")
    write_units "${headers[@]}"
    strict="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -I.."
    compilers=()
    for compiler in g++ g++-{12..20} clang++ clang++-{14..25}; do
        command -v "$compiler" >/dev/null || continue
        [[ $compiler == g++* ]] && (($("$compiler" -dumpversion | cut -d. -f1) < 12)) && continue
        real=$(readlink -f "$(command -v "$compiler")")
        [[ " ${compilers[*]} " == *" $real "* ]] || compilers+=("$real")
    done
    ((${#compilers[@]} > 0)) || { echo "there is neither GCC 12 nor clang" >&2; exit 1; }
    narrow=()
    [[ $(uname -m) != x86_64 ]] || narrow=("-std=c++20 -mavx" "-std=c++20 -mfma")
    {
        for unit in "$work"/*.cpp; do
            echo "${compilers[0]} -std=c++20 $strict $unit"
        done
        for compiler in "${compilers[@]}"; do
            for options in -std=c++20 -std=gnu++20 "-std=c++2b -march=native" -std=gnu++2b \
                "-std=c++20 -fno-exceptions -fno-rtti" "${narrow[@]}"; do
                echo "$compiler $options $strict $work/all.cpp"
            done
        done
        for compiler in "${compilers[@]}"; do
            for header in emulate_cuda.hpp $(find emulate_cuda -name '*.hpp' -o -name '*.h'); do
                option=-fsanitize=thread
                [[ $header != emulate_cuda/runtime[./]* ]] || option=
                unit=$work/${header//\//_}.emulate_cuda.cc
                printf '#include <warpagg/%s>\n' "$header" "$header" >"$unit"
                echo "$compiler -std=c++20 $strict $option $unit"
            done
        done
    } >"$work/commands"
    [[ " ${compilers[*]} " == *clang* ]] || echo "skipped: clang, which is not installed"
else
    suffix=cu
    compilers=("$1")
    mapfile -t headers < <(headers_but "${host_only[@]}" "${emulate_cuda[@]}")
    write_units "${headers[@]}"
    strict="-std=c++20 -arch=sm_80 -Werror all-warnings -Xcompiler -Wall,-Wextra,-Werror -I.. -o $work/output"
    for unit in "$work"/*.cu; do
        echo "$1 $strict.${unit##*/} -ptx $unit"
    done >"$work/commands"
    echo "$1 $strict.o -c $work/all.cu" >>"$work/commands"  # and as host code
fi
compile_all <"$work/commands"
echo "${#headers[@]} headers, $(wc -l <"$work/commands") compilations by ${compilers[*]}"
