#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Writes the Debian packages from a build folder, checks them with lintian, and installs and uses
# them in a new Debian 12 that has nothing but its smallest set of packages:
#   scripts/check_packages.sh BUILD
# Needs lintian, mmdebstrap and a mirror of Debian. Without root, mmdebstrap uses user namespaces,
# which need the package uidmap and a system that allows them.
set -euo pipefail
build=$(realpath "${1:?name the build folder}")
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"

cmake --build "$build" --target gaussian_splatting man_page_and_completion
cpack --config "$build/CPackConfig.cmake" -B "$work"
rm -rf "$work/_CPack_Packages"
as_root=()
((EUID != 0)) || as_root=(--allow-root)
lintian "${as_root[@]}" --fail-on error,warning "$work"/*.deb

cp -r tests/packaging/consumers tests/packaging/use_packages.sh "$work"
mmdebstrap --quiet --variant=minbase --dpkgopt=force-unsafe-io \
    --customize-hook="mkdir \"\$1/check\"" \
    --customize-hook="sync-in '$work' /check" \
    --customize-hook="env -i PATH='$PATH' chroot \"\$1\" bash /check/use_packages.sh" \
    bookworm /dev/null
