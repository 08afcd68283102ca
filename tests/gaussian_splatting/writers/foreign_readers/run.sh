#!/bin/bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Checks that programs of others read our files, and that we read theirs. Run by hand, because it needs npm:
#     run.sh PROGRAM [MODEL.ply]
# PROGRAM is gaussian_splatting. Without a model, it trains a small one. The packages go to a temporary folder.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
model=$(realpath -m "${2:-trained/point_cloud/iteration_300/point_cloud.ply}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$here/package.json" "$folder"
cd "$folder"
npm install --ignore-scripts --no-audit --no-fund --silent
transform() { node node_modules/@playcanvas/splat-transform/bin/cli.mjs -q -w "$@" > log 2>&1 || { cat log; exit 1; }; }
compare() { python3 "$here/compare.py" "$@"; }
convert() { "$program" convert -q "$@"; }

if [ $# -lt 2 ]; then
    "$program" train -q -d synthetic:spheres,gloss=0.5 -r 2 -i 300 --sh-degree 3 --sh-degree-interval 20 --device cpu \
        -o trained
    model=trained/point_cloud/iteration_300/point_cloud.ply
fi
cp "$model" model.ply
transform model.ply expected.csv

echo "our files, read by @playcanvas/splat-transform:"
for kind in compressed.ply splat spz sog; do
    convert model.ply "ours.$kind"
    transform "ours.$kind" ours.csv
    compare expected.csv ours.csv "$kind"
done
convert model.ply ours3.spz --spz-version 3
transform ours3.spz ours.csv
compare expected.csv ours.csv spz

echo "our files, read by @adobe/spz:"
for file in ours.spz ours3.spz; do
    node "$here/spz_to_csv.mjs" $file ours.csv > log
    compare expected.csv ours.csv spz
done

echo "our file, read by glb_to_csv.py:"
convert model.ply ours.glb
python3 "$here/glb_to_csv.py" ours.glb > ours.csv
compare expected.csv ours.csv glb

echo "files of @playcanvas/splat-transform, read by us:"
read_theirs() {
    convert "theirs.$1" back.ply
    transform back.ply back.csv
    compare expected.csv back.csv "$2"
}
transform model.ply theirs.compressed.ply
read_theirs compressed.ply compressed.ply
transform model.ply theirs.spz
read_theirs spz "their spz"
transform -g cpu -i 5 model.ply theirs.sog
read_theirs sog "their sog"
echo "all files agree"
