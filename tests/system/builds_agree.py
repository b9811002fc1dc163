#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Whether two builds, one for debugging and one optimised, say the same: both run the scenes, and every number that they
record is compared. A difference counts in units of the largest number of the same physical unit that the file holds, so
that a coordinate that should be nought is measured with the robot's size. Ends with 1 above 1e-9.

    python3 tests/system/builds_agree.py build/bin/cprsim build-debug/bin/cprsim [--jobs N] [scenes/robots/csg_published.xml ...]
"""
import argparse
import concurrent.futures
import csv
import glob
import math
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
MOST = 1e-9
# rods by every method, statics and motion, in a plane and in space, joints, tendons, fluid, contact; seconds that debugging
# builds can do in seconds
SCENES = [
    ("robots/csg_published.xml", None), ("robots/stewart_gough.xml", 0.05), ("robots/planar_3rr.xml", 0.5),
    ("robots/slider_crank.xml", 0.5), ("robots/spatial_3pfr.xml", 0.2), ("robots/planar_lab_tied.xml", 0.2),
    ("mechanics/released_rod.xml", 0.1), ("mechanics/joints.xml", 0.5), ("mechanics/dropped_box.xml", 0.2),
    ("tendons/till_tendon_dynamics.xml", 0.05), ("tendons/winding_tendons.xml", None), ("fluid/sinking_rod.xml", 0.1),
    ("effects/heated_bar.xml", None), ("loads/on_springs.xml", None), ("rods/localised_buckle.xml", None),
    ("contact/rod_on_floor.xml", 0.1), ("contact/crossing.xml", 0.05), ("contact/capstan.xml", None)]


def record(program, scene, duration, folder):
    """Runs a scene -> {file: rows of texts}, the header first."""
    words = [program, "run", scene, "-q", "--no-video", "-o", folder]
    words += ["--duration", str(duration)] if duration else []
    done = subprocess.run(words, capture_output=True, text=True)
    # 1: an expectation is not met, as of a run that was cut short
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{program} ended with {done.returncode}: {done.stderr.strip()}")
    files = {}
    for path in sorted(glob.glob(folder + "/*.csv")):
        with open(path, newline="") as file:
            files[os.path.basename(path)] = list(csv.reader(file))
    if not any(len(rows) > 1 for rows in files.values()):
        raise RuntimeError(f"{scene} records nothing")
    return files


def unit_of(column):
    found = re.search(r"\[([^\]]*)\]\s*$", column)
    return found.group(1) if found else ""


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def largest_difference(one, other):
    """-> (how much of the largest of its unit, column, time) where two files of the same name differ most."""
    header = one[0]
    if header != other[0] or len(one) != len(other):
        return math.inf, "the shape of the file", ""
    largest = {}
    for rows in (one, other):
        for row in rows[1:]:
            for column, text in zip(header, row):
                x = number(text)
                if x is not None and math.isfinite(x):
                    largest[unit_of(column)] = max(largest.get(unit_of(column), 0), abs(x))
    worst = (0.0, "", "")
    for a, b in zip(one[1:], other[1:]):
        for column, text_a, text_b in zip(header, a, b):
            if text_a == text_b:
                continue
            x, y = number(text_a), number(text_b)
            far = math.inf
            if x is not None and y is not None and math.isfinite(x) and math.isfinite(y):
                far = abs(x - y) / largest[unit_of(column)]
            worst = max(worst, (far, column, a[0]), key=lambda w: w[0])
    return worst


def compare(programs, scene, duration):
    """-> (numbers compared, the largest difference, where)."""
    with tempfile.TemporaryDirectory() as folder:
        runs = [record(os.path.abspath(p), scene, duration, os.path.join(folder, str(i))) for i, p in enumerate(programs)]
    if runs[0].keys() != runs[1].keys():
        return 0, math.inf, "the names of the files"
    count, worst = 0, (0.0, "", "")
    for name in runs[0]:
        count += sum(len(row) for row in runs[0][name][1:])
        worst = max(worst, largest_difference(runs[0][name], runs[1][name]), key=lambda w: w[0])
    return count, worst[0], f"{worst[1]} at {worst[2]} s" if worst[1] else ""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", nargs=2)
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    words = parser.parse_intermixed_args()
    todo = [(s, None) for s in words.scenes] or [(os.path.join(ROOT, "scenes", s), d) for s, d in SCENES]
    with concurrent.futures.ThreadPoolExecutor(words.jobs) as pool:
        waiting = [pool.submit(compare, words.programs, *work) for work in todo]
    good = True
    print("| scene | s | numbers | largest difference | where |\n|---|---|---|---|---|")
    for (scene, duration), result in zip(todo, waiting):
        name = os.path.relpath(scene, ROOT)
        try:
            count, far, where = result.result()
        except RuntimeError as error:
            count, far, where = 0, math.inf, str(error)
        good = good and far <= MOST
        print(f"| {name} | {duration or 'all'} | {count} | {far:.1e} | {where} |")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
