#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Which branches of the sources the tests go through: builds with clang++ and its counters, runs the tests, and adds up by
folder. A branch is one way of a condition, as clang-14's llvm-cov counts them; what stands in templates and headers counts
once. Runs that are killed on purpose leave no counts.

    python3 tests/coverage/coverage.py [--folder build-coverage] [--jobs N] [--programs loader_test,meshes_test] [--page docs/coverage.md]
"""
import argparse
import glob
import json
import os
import subprocess

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
COUNTERS = "-fprofile-instr-generate -fcoverage-mapping"
# what must hold: folders, and the least share of their branches
GATES = [("loader and outputs", ["scenes/loader", "tools/sinks", "tools/gltf", "tools/hdf5"], 0.9),
         ("the rest", ["engine", "collision", "render", "tools/cprsim", "tools/series"], 0.8)]


def build(folder, jobs, programs):
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_CXX_COMPILER=clang++",
                    "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O1 " + COUNTERS, "-DCPRSIM_BENCHMARKS=OFF"],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["ninja", "-C", folder, f"-j{jobs}", *programs], check=True, stdout=subprocess.DEVNULL)


def run_tests(folder, jobs, programs):
    counts = os.path.join(folder, "counts")
    for old in glob.glob(counts + "/*"):
        os.remove(old)
    # programs of one kind add to the same few files
    variables = dict(os.environ, LLVM_PROFILE_FILE=counts + "/%4m.profraw")
    command = ["ctest", "--test-dir", folder, f"-j{jobs}", "--output-on-failure", "--timeout", "3600"]
    only = ["-R", "^(" + "|".join(programs) + ")$"] if programs else []
    subprocess.run(command + only, env=variables, check=True)
    merged = os.path.join(folder, "merged.profdata")
    subprocess.run(["llvm-profdata", "merge", "-sparse", "-o", merged, *glob.glob(counts + "/*.profraw")], check=True)
    return merged


def files_of(folder, merged):
    """path -> (branches, those gone through, lines, those gone through)."""
    programs = [path for path in glob.glob(folder + "/bin/*") if os.access(path, os.X_OK) and os.path.isfile(path)]
    objects = [word for path in programs[1:] for word in ("-object", path)]
    exported = subprocess.run(["llvm-cov", "export", "-summary-only", "-instr-profile", merged, programs[0], *objects],
                              check=True, capture_output=True, text=True).stdout
    found = {}
    for file in json.loads(exported)["data"][0]["files"]:
        path = os.path.relpath(file["filename"], ROOT)
        if path.startswith("..") or path.startswith("tests") or path.startswith("build"):
            continue
        branches, lines = file["summary"]["branches"], file["summary"]["lines"]
        found[path] = [branches["count"], branches["covered"], lines["count"], lines["covered"]]
    return found


def total(files, folders):
    sums = [0, 0, 0, 0]
    for path, counts in files.items():
        if any(path.startswith(folder + "/") for folder in folders):
            sums = [a + b for a, b in zip(sums, counts)]
    return sums


def share(part, whole):
    return f"{100 * part / whole:.1f} %" if whole else "-"


def report(files):
    lines = ["| folder | branches | gone through | lines | gone through |", "|---|---|---|---|---|"]
    good = True
    for name, folders, least in GATES:
        inner = sorted({os.path.dirname(path) for path in files if any(path.startswith(f + "/") for f in folders)})
        for folder in inner:
            b, bc, l, lc = total(files, [folder])
            lines.append(f"| {folder} | {b} | {share(bc, b)} | {l} | {share(lc, l)} |")
        b, bc, l, lc = total(files, folders)
        good = good and b > 0 and bc >= least * b
        lines.append(f"| **{name}**, at least {100 * least:.0f} % | {b} | **{share(bc, b)}** | {l} | {share(lc, l)} |")
    return lines, good


def least_covered(files, most):
    rows = sorted(((b - bc, path, b, bc) for path, (b, bc, _, _) in files.items()), reverse=True)
    return [f"| {path} | {b} | {share(bc, b)} |" for _, path, b, bc in rows[:most]]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", default=os.path.join(ROOT, "build-coverage"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--programs", default="", help="only these tests, separated by commas")
    parser.add_argument("--page")
    words = parser.parse_args()
    programs = [name for name in words.programs.split(",") if name]
    build(words.folder, words.jobs, programs)
    files = files_of(words.folder, run_tests(words.folder, words.jobs, programs))
    table, good = report(files)
    print("\n".join(table))
    if words.page:
        text = ["# Which branches the tests go through", "",
                "Made by `python3 tests/coverage/coverage.py --page docs/coverage.md`: every test of `ctest`, built with "
                "clang++ and its counters. A branch is one way of a condition.", "", *table, "",
                "Files with the most branches that no test takes:", "", "| file | branches | gone through |", "|---|---|---|",
                *least_covered(files, 15)]
        with open(words.page, "w") as page:
            page.write("\n".join(text) + "\n")
    raise SystemExit(0 if good else 1)


if __name__ == "__main__":
    main()
