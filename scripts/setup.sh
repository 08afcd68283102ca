#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Installs what building and testing needs on Debian 12. Asks nothing, and does nothing where all is there.
#   scripts/setup.sh [further packages]
set -euo pipefail

packages=(cmake ninja-build g++ git libglm-dev libcli11-dev nlohmann-json3-dev doctest-dev
    libpng-dev libjpeg62-turbo-dev libnanoflann-dev "$@")

distribution=$(. /etc/os-release 2>/dev/null && echo "${ID:-unknown}" || echo unknown)
if [[ $distribution != debian ]] || ! command -v apt-get >/dev/null; then
    echo "This script knows Debian only: install what your distribution calls ${packages[*]}." >&2
    exit 1
fi

is_installed() { [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

missing=()
for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    echo "All packages are installed."
    exit 0
fi

as_root=()
if ((EUID != 0)); then
    command -v sudo >/dev/null || {
        echo "Run this script as root, or install sudo, for it to install ${missing[*]}." >&2
        exit 1
    }
    as_root=(sudo)
fi
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "${missing[@]}"
