#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Fuzzes the trainer's loaders with clang's libFuzzer, one after another; ends with an error if one of them
# crashes, leaks, hangs, or allocates more than four times its file. What was found stays in $OUT (build/fuzz).
# Needs clang and its runtime libraries, on Debian 12: clang libclang-rt-14-dev.
#   tests/gaussian_splatting/fuzz/run.sh SECONDS [harness...]
# To keep what was newly covered: build/fuzz/ply -merge=1 tests/gaussian_splatting/fuzz/corpus/ply build/fuzz/corpus/ply
set -euo pipefail
cd "$(dirname "$0")/../../.."

seconds=${1:?usage: tests/gaussian_splatting/fuzz/run.sh SECONDS [harness...]}
shift
harnesses=("$@")
((${#harnesses[@]})) || mapfile -t harnesses < <(ls tests/gaussian_splatting/fuzz/corpus)
out=$(realpath -m "${OUT:-build/fuzz}")
mkdir -p "$out"

trainer=examples/gaussian_splatting
sources=("$trainer"/readers/colmap/colmap_{binary,records,text}.cpp "$trainer"/image/{,codecs/}*.cpp
    "$trainer"/readers/transforms/transforms{,_pose}.cpp "$trainer"/readers/polycam/polycam_camera.cpp
    "$trainer"/readers/opensfm/opensfm_{files,record}.cpp
    "$trainer"/readers/{camera_models,json_events,json_text,point_cloud,scene_archive,validation}.cpp
    "$trainer"/scene/{camera,undistort}.cpp "$trainer"/{cluster,writers,writers/*}/*.cpp
    tests/gaussian_splatting/fuzz/{archive,budget,colmap,harness,harnesses,image,opensfm,point_cloud,polycam,transforms}.cpp)
flags=(-std=c++20 -O1 -g -fno-omit-frame-pointer -I"$trainer" -Iinclude -Itests/gaussian_splatting/fuzz
    $(pkg-config --cflags libheif)
    -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all)

objects=()
for source in "${sources[@]}"; do
    objects+=("$out/$(basename "$(dirname "$source")")_$(basename "$source" .cpp).o")
    clang++ "${flags[@]}" -fsanitize=fuzzer-no-link -c "$source" -o "${objects[-1]}"
done
for harness in "${harnesses[@]}"; do
    clang++ "${flags[@]}" -fsanitize=fuzzer -DWARPAGG_HARNESS="\"$harness\"" tests/gaussian_splatting/fuzz/entry.cpp "${objects[@]}" \
        -lpng -ljpeg -lwebp -lwebpdemux -lheif -lexif -lz -lzip -lzstd -o "$out/$harness"
done

failed=0
for harness in "${harnesses[@]}"; do
    corpus=$out/corpus/$harness
    mkdir -p "$corpus" "$out/found"
    options=(-max_total_time="$seconds" -seed=1 -max_len=65536 -timeout=10 -rss_limit_mb=1024 -print_final_stats=1
        -artifact_prefix="$out/found/$harness-")
    [[ -f tests/gaussian_splatting/fuzz/$harness.dict ]] && options+=(-dict="tests/gaussian_splatting/fuzz/$harness.dict")
    result=passed
    "$out/$harness" "${options[@]}" "$corpus" "tests/gaussian_splatting/fuzz/corpus/$harness" >"$out/$harness.log" 2>&1 ||
        { result="FAILED, see $out/$harness.log" && failed=1; }
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$out/$harness.log")
    coverage=$({ grep -o ' cov: [0-9]*' "$out/$harness.log" || true; } | tail -1)
    printf '%s: %s executions,%s, %s\n' "$harness" "${executions:-no}" "${coverage:- no coverage}" "$result"
done
exit $failed
