#!/bin/bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Checks that viewers of others draw our files as we do, in headless Chromium. Run by hand, because
# it needs npm:
#     draw.sh PROGRAM [SCREENSHOTS]
# PROGRAM is gaussian_splatting. The images go to the folder SCREENSHOTS. The packages go to a
# temporary folder.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
screenshots=$(realpath -m "${2:-$folder/screenshots}")
mkdir -p "$screenshots"
cp "$here"/viewers/* "$folder"
cd "$folder"
npm install --ignore-scripts --no-audit --no-fund --silent
# Strongly view-dependent colors make a wrong SH coefficient visible.
"$program" train -q -d synthetic:spheres,gloss=1 -r 2 -i 400 --effects auto,+antialiasing --sh-degree 3 \
    --sh-degree-interval 20 --sh-lr 0.01 --device cpu -o trained
python3 "$here/draw.py" "$program" trained/point_cloud/iteration_400/point_cloud.ply "$folder" "$screenshots"
