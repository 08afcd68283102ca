#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Installs and uses the packages that lie beside this file. It changes the system, so that only
# scripts/check_packages.sh runs it, in a new Debian that is then removed.
set -euo pipefail
cd "$(dirname "$0")"
export DEBIAN_FRONTEND=noninteractive OMP_WAIT_POLICY=passive
install() { apt-get install -qqy --no-install-recommends "$@" >install.log || { cat install.log; exit 1; }; }

# The program runs with no other packages than those that its package names.
install ./*.deb
version=$(dpkg-query -W -f '${Version}' warpagg-gaussian-splatting)
[[ $(gaussian_splatting --version) == "$version" ]]
gaussian_splatting train -d synthetic:spheres -r 64 -i 50 --device cpu -o trained
test -s trained/point_cloud/iteration_50/point_cloud.ply
test -s /usr/share/man/man1/gaussian_splatting.1.gz
bash -c 'source /usr/share/bash-completion/completions/gaussian_splatting && complete -p gaussian_splatting'

# The headers need a compiler only.
install g++
g++ -std=c++20 consumers/stranger.cpp -o stranger
./stranger
install cmake make pkgconf
cmake -S consumers/find_package -B found
cmake --build found
found/stranger
[[ $(pkgconf --modversion warpagg) == "$version" ]]

apt-get purge -qqy libwarpagg-dev warpagg-gaussian-splatting >install.log
[[ ! -e /usr/include/warpagg && ! -e /usr/bin/gaussian_splatting ]]
echo "The packages of version $version were installed, used and removed."
