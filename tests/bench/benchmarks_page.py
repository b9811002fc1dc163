#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs cprsim_bench and writes what it found as a page.

    python3 tests/bench/benchmarks_page.py build/bin/cprsim_bench docs/benchmarks.md

Each benchmark is repeated, the repetitions of all benchmarks mixed in random order, and the smallest time
counts: on a machine shared with others, the rest is theirs. Where valgrind is installed, instructions are counted too.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

REPETITIONS = 9


def run(program, arguments):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.json")
        subprocess.run([program, "--benchmark_out=" + out, "--benchmark_out_format=json", *arguments], check=True)
        with open(out) as file:
            return json.load(file)


def smallest(results):
    """Name without suffixes -> the repetition with the smallest time, times in seconds."""
    units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}
    best = {}
    for entry in results["benchmarks"]:
        if entry.get("run_type") == "aggregate":
            continue
        if entry.get("error_occurred"):
            raise SystemExit(entry["name"] + ": " + entry["error_message"])
        name = re.sub(r"/(iterations:\d+|process_time|real_time)", "", entry["name"])
        entry["wall"] = entry["real_time"] * units[entry["time_unit"]]
        entry["cpu"] = entry["cpu_time"] * units[entry["time_unit"]]
        entry["cost"] = entry["wall"] if "real_time" in entry["name"] else entry["cpu"]
        if name not in best or entry["cost"] < best[name]["cost"]:
            best[name] = entry
    return best


def count_instructions(program, benchmark, function, calls):
    """Instructions of one call of `function`, which the benchmark calls so often when it iterates once."""
    pattern = "^" + re.escape(benchmark) + "$"
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--callgrind-out-file=" + os.path.join(folder, "out"),
             "--toggle-collect=*" + function + "*", program, "--benchmark_filter=" + pattern,
             "--benchmark_min_time=1e-9"], capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1)) / calls


def table(file, heads, rows):
    file.write("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads) + "\n")
    for row in rows:
        file.write("| " + " | ".join(row) + " |\n")
    file.write("\n")


def number(x):
    return f"{x:.3g}" if x < 1000 else f"{x:,.0f}".replace(",", " ")


class Page:
    def __init__(self, file, best):
        self.file = file
        self.best = best
        self.yardstick = best["rk4_section_step"]["cost"]

    def micro(self, name):
        return number(self.best[name]["cost"] * 1e6)

    def steps(self, name):
        return number(self.best[name]["cost"] / self.yardstick)

    def statics(self, program):
        self.file.write("## Standing still\n\nThe published Stewart-Gough robot, six rods with extension and shear, "
                        "gauss6, residual 1e-8. Cold: from straight legs, with no guess. Warm: every leg steps by a "
                        "thousandth of its length. Error: of the plate's position, against 32 cells.\n\n")
        counted = shutil.which("valgrind") is not None
        rows = []
        for kind, function, calls in (("cold", "find_from_straight_legs", 1), ("warm", "follow_actuators", 2)):
            for cells in (3, 4, 6):
                name = f"static_solve_{kind}/cells:{cells}"
                entry = self.best[name]
                row = [kind, str(cells), self.micro(name), self.steps(name), number(entry["iterations_of_newton"]),
                       f"{entry['error_m']:.1e}"]
                if counted:
                    row.append(number(count_instructions(program, name, function, calls) / 1e6))
                rows.append(row)
        heads = ["solve", "cells a rod", "µs", "RK4 steps", "iterations", "error, m"]
        table(self.file, heads + (["million instructions (callgrind, AVX2)"] if counted else []), rows)

    def dynamics(self):
        self.file.write("## Moving\n\nOne step of 1/120 s of the same robot while one leg's length follows a sine of "
                        "10 mm and 1 Hz, with gravity, damping, energies and the observed state; residual 1e-9.\n\n")
        rows = []
        for scheme in ("esdirk32", "generalized_alpha", "bdf_alpha"):
            for cells in (3, 6):
                for extensible in (0, 1):
                    name = f"dynamic_step/{scheme}/cells:{cells}/extensible:{extensible}"
                    entry = self.best[name]
                    rows.append([f"`{scheme}`", str(cells), "on" if extensible else "off", self.micro(name),
                                 self.steps(name), number(entry["iterations_of_newton"]),
                                 number(1 / 120 / entry["cost"])])
        table(self.file, ["scheme", "cells a rod", "extension, shear", "µs", "RK4 steps", "iterations",
                          "times faster than real time"], rows)

    def sweeps(self):
        self.file.write("## Sweeps of one rod\n\nResidual: the balance from base to tip. Variational: its exact "
                        "linearisation, condensed to the rod's two ends.\n\n")
        rows = []
        for cells in (3, 6):
            for moving in (0, 1):
                for extensible in (0, 1):
                    arguments = f"/cells:{cells}/extensible:{extensible}/moving:{moving}"
                    row = [str(cells), "yes" if moving else "no", "on" if extensible else "off"]
                    for sweep in ("residual_sweep", "variational_sweep"):
                        row += [self.micro(sweep + arguments), self.steps(sweep + arguments)]
                    rows.append(row)
        table(self.file, ["cells", "moving", "extension, shear", "residual, µs", "RK4 steps", "variational, µs",
                          "RK4 steps"], rows)

    def planar(self):
        self.file.write("## In a plane\n\nTwo rods of 1 m clamped to driven cranks and joined by a hinge "
                        "(tests/support/planar_robots.h), 6 cells of gauss6 a rod, gravity: the same scene with "
                        "`<planar>` and without, the same motion to 1e-9 (`planar_laws_test`). Sweeps are those of one "
                        "rod between moving bodies; equilibrium from straight rods, residual 1e-8; steps of 1/120 s of "
                        "esdirk32 while both cranks swing.\n\n")
        rows = []
        names = {"residual": "residual sweep", "variational": "variational sweep", "static": "equilibrium",
                 "step": "time step"}
        for kind, what in names.items():
            for extensible in (0, 1):
                for moving in (0, 1) if kind in ("residual", "variational") else (None,):
                    arguments = f"/extensible:{extensible}" + ("" if moving is None else f"/moving:{moving}")
                    spatial, planar = (f"two_rods_{kind}/planar:{p}{arguments}" for p in (0, 1))
                    rows.append([what + (", moving" if moving else ""), "on" if extensible else "off",
                                 self.micro(spatial), self.micro(planar), self.steps(planar),
                                 f"{self.best[spatial]['cost'] / self.best[planar]['cost']:.1f}"])
        table(self.file, ["what", "extension, shear", "spatial, µs", "planar, µs", "RK4 steps (planar)",
                          "times cheaper"], rows)

    def pictures(self):
        device = self.best["draw_frame/fixed_camera"].get("label", "")
        self.file.write("## Pictures\n\nSix rods and two plates at 1280 x 720 with shadows, 4 samples a pixel, drawn "
                        f"by {device} without a graphics card. The film draws and encodes (H.264) in threads beside "
                        "each other; its processor time is without the encoder.\n\n")
        rows = []
        for name, what in (("draw_frame/fixed_camera", "a frame, fixed camera"),
                           ("draw_frame/orbiting_camera", "a frame, orbiting camera"),
                           ("film_of_four_seconds", "a film of 121 frames, fixed camera")):
            entry = self.best[name]
            rows.append([what, number(entry["wall"] * 1e3), number(entry["cpu"] * 1e3), self.steps(name),
                         number(entry["frames/s"])])
        table(self.file, ["what", "wall, ms", "processor, ms", "RK4 steps (wall)", "frames/s"], rows)


def machine():
    model = "an unnamed processor"
    with open("/proc/cpuinfo") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
    return f"{model}, {os.cpu_count()} logical processors"


def main():
    program, path = sys.argv[1:]
    best = smallest(run(program, [f"--benchmark_repetitions={REPETITIONS}", "--benchmark_min_time=0.1",
                                  "--benchmark_enable_random_interleaving=true"]))
    with open(path, "w") as file:
        page = Page(file, best)
        file.write("# Benchmarks\n\nMade by `python3 tests/bench/benchmarks_page.py build/bin/cprsim_bench "
                   f"docs/benchmarks.md` on {machine()}, shared with other work; the smallest of {REPETITIONS} "
                   "repetitions, on one core unless said otherwise.\n\n"
                   "An RK4 step is the yardstick that carries over to other machines: one classical Runge-Kutta step "
                   f"of a rod section in plain scalar code (tests/bench/reference_kernel.cpp), here "
                   f"{page.yardstick * 1e9:.0f} ns, timed among the others. How accurate all this is: "
                   "[accuracy/released_rod.md](accuracy/released_rod.md).\n\n")
        page.statics(program)
        page.dynamics()
        page.sweeps()
        page.planar()
        page.pictures()


if __name__ == "__main__":
    main()
