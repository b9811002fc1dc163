#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# clang-tidy, as .clang-tidy says, over all sources that are built, or those below a folder (a regular expression):
#   tools/tidy.sh [engine/solve]
set -euo pipefail
cd "$(dirname "$0")/.."

# file by file, with a compiler whose options clang-tidy knows
cmake -S . -B build-tidy -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Debug -DCPRSIM_UNITY=OFF \
      -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCPRSIM_BENCHMARKS=OFF > /dev/null
run-clang-tidy -quiet -p build-tidy -j "$(nproc)" "$PWD/(${1:-engine|scenes|collision|render|tools})/"
