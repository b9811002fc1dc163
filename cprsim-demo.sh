#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds cprsim and lets the continuum Stewart-Gough robot move, filmed without a display.
set -euo pipefail
cd "$(dirname "$0")"
out=out/stewart_gough

./tools/install-deps.sh
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release
cmake --build build --target cprsim
./build/bin/cprsim scenes/robots/stewart_gough.xml -o "$out" --video "$out/stewart_gough.mp4" \
    --still "$out/stewart_gough.png@1.2" "$@"

echo
echo "film      $PWD/$out/stewart_gough.mp4"
echo "still     $PWD/$out/stewart_gough.png"
echo "channels  $PWD/$out/stewart_gough.csv"
echo "report    $PWD/$out/run.json"
