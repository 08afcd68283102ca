#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Installs the packages that building and testing need, on Debian 12 and Ubuntu 24.04. It asks no
# questions, and does nothing if all packages are installed.
#   scripts/setup.sh [further packages]
set -euo pipefail

distribution=$(. /etc/os-release 2>/dev/null && echo "${ID:-unknown}" || echo unknown)
packages=(cmake ninja-build g++ git libglm-dev libcli11-dev nlohmann-json3-dev doctest-dev
    libpng-dev libjpeg-dev libwebp-dev libheif-dev libexif-dev pkg-config libnanoflann-dev libzip-dev libzstd-dev
    libcpp-httplib-dev "$@")
# Debian's libheif contains its codecs; Ubuntu's loads them from packages of their own.
[[ $distribution != ubuntu ]] ||
    packages+=(libheif-plugin-{aomdec,aomenc,libde265,x265})
if [[ $distribution != @(debian|ubuntu) ]] || ! command -v apt-get >/dev/null; then
    echo "error: this script installs packages on Debian and Ubuntu only; install the equivalents of ${packages[*]}" >&2
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
