#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures what each effect adds to a section of a rod and writes the table of docs/effects.md.

    python3 tests/effects/effects_page.py build/bin docs/effects.md           # needs valgrind
    python3 tests/effects/effects_page.py build/bin docs/effects.md --check   # that what the table names exists

Instructions are those of valgrind, which runs the kernels for AVX2. Times are those of the widest kernels of the machine,
told as multiples of what a section of a plain rod takes in the same process: both are swept in turns, and the
fastest sweep of each counts, of several processes.
"""
import os
import re
import subprocess
import sys
import tempfile

BEGIN, END = "<!-- costs: begin -->\n", "<!-- costs: end -->\n"
METHODS = ["shooting", "strain", "collocation"]
REPEATS = 5

# effect, scene line, what it adds, case of costed_rods.cpp (or None), what that is compared with, test, source
EFFECTS = [
    ("bending, torsion", "always there", "the rod, at rest, unloaded", "none, at rest", None,
     "tests/laws/cantilever_test.cpp", "engine/rod/unloaded_kernel.cpp"),
    ("motion", 'mode="dynamic"', "inertia of the centreline", "none, moving", "none, at rest",
     "tests/laws/free_vibration_test.cpp", "engine/rod/cell_kernel.cpp"),
    ("gravity", "<gravity/>", "a constant force", "gravity", "none, at rest", "tests/laws/cantilever_test.cpp",
     "engine/rod/cell_kernel.cpp"),
    ("extension", "<extension/>", "stretch, at rest", "extension, at rest", "none, at rest",
     "tests/laws/cantilever_test.cpp", "engine/rod/cell_kernel.cpp"),
    ("", "", "stretch, in motion", "extension, moving", "none, moving", "tests/laws/free_vibration_test.cpp",
     "engine/rod/cell_kernel.cpp"),
    ("shear", "<shear/>", "shear, at rest", "shear, at rest", "none, at rest", "tests/laws/cantilever_test.cpp",
     "engine/rod/cell_kernel.cpp"),
    ("", "", "shear, in motion", "shear, moving", "none, moving", "tests/laws/free_vibration_test.cpp",
     "engine/rod/cell_kernel.cpp"),
    ("rotary inertia", "<rotary_inertia/>", "angular momentum of sections", "rotary_inertia", "none, moving",
     "tests/engine/section/rotary_test.cpp", "engine/section/rotary.h"),
    ("damping", "<damping/> and the rod's <damping>", "strain rates in the law", "damping", "none, moving",
     "tests/laws/energy_test.cpp", "engine/rod/shooting.cpp"),
    ("fluid", "<drag/> and the rod's <drag>", "drag, buoyancy, added mass", "drag", "none, moving",
     "tests/laws/fluid_test.cpp", "engine/section/fluid.h"),
    ("load along a rod", '<cprsim:load along="...">', "a force and a moment per length", "load along it",
     "none, at rest", "tests/laws/line_load_test.cpp", "engine/section/line_load.h"),
    ("tendons", "<cprsim:tendon>", "their pull in the law", "tendon", "none, at rest", "tests/laws/tendon_test.cpp",
     "engine/section/tendon_law.h"),
    ("tendon friction", "<tendon_friction/> and the tendon's <friction>", "how tensions fall along it", "tendon friction",
     "tendon", "tests/laws/tendon_friction_test.cpp", "engine/rod/tendon_friction.cpp"),
    ("varying sections", 'several <cross_section s="...">', "coefficients of every section", "varying sections",
     "none, at rest", "tests/laws/varying_rod_test.cpp", "engine/section/along.cpp"),
    ("magnetic", "<magnetic/> and the rod's <magnetization>", "a moment per length in a uniform field",
     "magnetic, uniform field", "none, at rest", "tests/laws/magnetic_test.cpp", "engine/section/magnetic_load.h"),
    ("", "", "a moment and a force next to a dipole", "magnetic, dipole", "none, at rest",
     "tests/laws/magnetic_test.cpp", "engine/section/magnetic_load.h"),
    ("thermal", "<thermal/> and the rod's <temperature>", "other rest strains, set once a solve", "thermal",
     "extension, at rest", "tests/laws/thermal_test.cpp", "engine/robot/forcing.cpp"),
    ("disks", "<disks>", "two jumps of the internal force", "disks", "gravity", "tests/laws/disks_test.cpp",
     "engine/rod/rod_disks.cpp"),
    ("planar", '<planar normal="0 1 0"/>', "takes away: one angle for a rotation, at rest", "planar, at rest",
     "none, at rest", "tests/laws/planar_test.cpp", "engine/rod/planar_cell_kernel.cpp"),
    ("", "", "takes away, in motion", "planar, moving", "none, moving", "tests/laws/planar_test.cpp",
     "engine/rod/planar_cell_kernel.cpp"),
    ("contact", "<contact/>", "3 unknowns where something touches; a search for it", None, None,
     "tests/collision/contact_test.cpp", "engine/robot/contacts.cpp"),
    ("friction", "<friction/>", "no unknowns: the law of a contact's force", None, None,
     "tests/laws/capstan_test.cpp", "engine/robot/contact_pair.cpp"),
    ("self-contact", "<self_contact/>", "as contact, of a rod with itself", None, None,
     "tests/laws/looped_rod_test.cpp", "engine/robot/contact_search.cpp"),
]


def instructions(program, case):
    """Of one sweep; None where valgrind does not know an instruction of the machine's."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            ["valgrind", "--quiet", "--tool=callgrind", "--callgrind-out-file=counts",
             "--toggle-collect=measured_sweep", "--dump-after=measured_sweep", program, *case],
            cwd=folder, capture_output=True, text=True)
        if run.returncode != 0:
            return None
        with open(os.path.join(folder, "counts.1"), encoding="utf-8") as counts:
            return int(re.search(r"^summary: (\d+)", counts.read(), re.M)[1])


def measure(program):
    """Sections, unknowns, instructions and nanoseconds of each case."""
    program = os.path.abspath(program)

    def output(*words):
        return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout.splitlines()

    rows = {}
    for line in output("cases"):
        case = tuple(line.split(";"))
        runs = [output(*case, "timed")[0].split(";") for _ in range(REPEATS)]
        best, plain = (min(float(run[k]) for run in runs) for k in (2, 3))
        rows[case] = dict(sections=int(runs[0][0]), unknowns=int(runs[0][1]), ns=best, ratio=best / plain,
                          instructions=instructions(program, case))
    return rows


def signed(value, digits=0):
    text = f"{value:+,.{digits}f}"
    return "0" if float(text.replace(",", "")) == 0 else text


def cell(rows, method, case, base):
    if case is None:
        return "", ""
    here = rows[method, case]
    per = (here["instructions"] or 0) / here["sections"]
    if base is None:
        return f"{per:,.0f}, {here['ns']:,.0f} ns", f"{here['unknowns']}"
    there = rows[method, base]
    added = per - there["instructions"] / there["sections"]
    unknowns = here["unknowns"] - there["unknowns"]
    counted = signed(added) + ", " if here["instructions"] else ""
    return f"{counted}{here['ratio']:.2f}×", signed(unknowns)


def table(rows):
    lines = ["| effect | scene | adds | unknowns: shooting, strain, collocation | a section of shooting | of strain |"
             " of collocation | test | source |", "|---" * 9 + "|"]
    for effect, scene, adds, case, base, test, source in EFFECTS:
        cells = [cell(rows, method, case, base) for method in METHODS]
        scene = re.sub(r"(<[^>]*>|\w+=\"[^\"]*\")", r"`\1`", scene)
        unknowns = ", ".join(unknown for _, unknown in cells) if case else ""
        lines.append("| " + " | ".join([effect, scene, adds, unknowns] + [cost for cost, _ in cells] +
                                       [f"[{os.path.basename(test)}](../{test})",
                                        f"[{os.path.basename(source)}](../{source})"]) + " |")
    return "\n".join(lines) + "\n"


def check(page, text):
    """What the table names lies in the source tree, and every effect that scenes may list is in it."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(page)))
    wrong = [path for row in EFFECTS for path in row[5:7] if not os.path.exists(os.path.join(root, path))]
    wrong += [f"{row[0] or row[2]} is not in the page" for row in EFFECTS if f"| {row[2]} |" not in text]
    with open(os.path.join(root, "engine/model/effects.cpp"), encoding="utf-8") as source:
        names = re.findall(r'"(\w+)"', source.read().split("kNames")[1])
    for name in names:
        if not any(f"<{name}/>" in row[1] for row in EFFECTS):
            wrong.append(f"<{name}/> is in no row")
    if wrong:
        sys.exit("effects_page.py: " + "; ".join(wrong))


def main():
    folder, page = sys.argv[1:3]
    with open(page, encoding="utf-8") as file:
        text = file.read()
    if "--check" in sys.argv:
        check(page, text)
        return
    before, rest = text.split(BEGIN)
    with open(page, "w", encoding="utf-8") as file:
        file.write(before + BEGIN + table(measure(os.path.join(folder, "cprsim_section_costs"))) + END +
                   rest.split(END)[1])


if __name__ == "__main__":
    main()
