#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Everything a change must pass: formatting, and all tests (those of the layers among them)
# in a release build and again with sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."

echo "== formatting"
git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format --dry-run -Werror

echo "== release"
./tools/test.sh

echo "== sanitizers"
# g++ takes minutes for single files with sanitizers, clang++ a tenth of that
if command -v clang++ >/dev/null; then export CXX=clang++; fi
cmake -S . -B build-sanitize -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCPRSIM_SANITIZE=ON -DCPRSIM_BENCHMARKS=OFF
cmake --build build-sanitize
ctest --test-dir build-sanitize --output-on-failure

echo "== both builds say the same"
python3 tests/system/builds_agree.py build/bin/cprsim build-sanitize/bin/cprsim
