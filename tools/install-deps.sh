#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs everything cprsim needs to build, run and test on Debian 12: Debian packages only.
# Does nothing (and needs no root) when all of them are already there.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config ccache
  libeigen3-dev libbullet-dev libassimp-dev libtinyxml2-dev libstb-dev
  libsundials-dev libhdf5-dev libminizip-dev
  libegl-dev libopengl-dev libgl-dev libgl1-mesa-dri libegl-mesa0
  nlohmann-json3-dev libcli11-dev libfmt-dev libxxhash-dev
  ffmpeg fonts-dejavu-core
  libgtest-dev libbenchmark-dev libsdformat-dev trang jing libxml2-utils
  clang-format python3 gnuplot-nox valgrind
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

run=()
[ "$(id -u)" -eq 0 ] || run=(sudo)
export DEBIAN_FRONTEND=noninteractive
echo "installing: ${missing[*]}"
"${run[@]}" apt-get -o DPkg::Lock::Timeout=300 update -qq
"${run[@]}" apt-get -o DPkg::Lock::Timeout=300 install -y -qq --no-install-recommends "${missing[@]}"
