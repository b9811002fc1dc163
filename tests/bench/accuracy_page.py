#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps scenes with every scheme and method and writes what accuracy costs as a page.

    python3 tests/bench/accuracy_page.py build/bin/cprsim docs          # minutes
    python3 tests/bench/accuracy_page.py build/bin/cprsim DIR --quick    # fewer settings, to see that it works

Writes DIR/accuracy.md and, per scene, DIR/accuracy/NAME.svg and NAME.csv.
"""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

SCENES = [
    ("scenes/mechanics/released_rod.xml", [],
     "A steel rod, 0.4 m long and 2 mm thick, clamped upright, is bent by 1 N at its tip and let go; it swings for a "
     "second. The error is that of the tip."),
    ("scenes/robots/planar_2pr.xml", ["--duration", "1"],
     "Two rods in a plane hold an end effector and are pushed by two sliders; the first second of the motion."),
    ("scenes/robots/stewart_gough.xml", ["--duration", "0.5", "--quick"],
     "Six rods carry a platform, whose motors begin to move; half a second, every scheme with two steps or tolerances."),
    ("scenes/robots/slider_crank.xml", [],
     "A crank pushes a slider through an elastic rod, slowly: a hundred equilibria, one after the other."),
    ("scenes/robots/csg_published.xml", [],
     "The six-rod robot of the literature in one equilibrium, found from straight rods."),
    ("scenes/rods/tapered.xml", [],
     "A cantilever at rest, thinner towards its tip."),
    ("scenes/rods/bundle.xml", ["--duration", "0.3", "--quick"],
     "Three wires with damping, bound together, swing when a force lets go of them."),
    ("scenes/fluid/sinking_rod.xml", ["--duration", "0.3", "--quick"],
     "A rod that nothing holds sinks in water, lying across its way."),
    ("scenes/tendons/till_tendon_dynamics.xml", ["--duration", "1", "--quick"],
     "A tendon robot of the literature: a motor pulls in its tendon, and gives it back."),
    ("scenes/contact/over_a_cylinder.xml", ["--quick"],
     "The clamp of a level rod is raised against a cylinder that holds the rod down, one equilibrium after the other."),
]

PREFACE = """# What accuracy costs

cprsim can solve the same scene coarsely in a moment or finely in a while. This page shows, for scenes that are shipped,
how large the error is and how long the solution takes, for every time scheme and every method. It is made by

    {command}

and the same for your own scene is one command: `cprsim sweep scene.xml`, which writes a page with the picture.

**Error** is how far the solution strays from a much finer one (its settings stand with each scene), at the worst of
1001 instants, ends of steps or not. **CPU time** is that of one core for building, starting and stepping, without files
and pictures, the best of three where runs are short. It was taken on {machine}, shared with other work (revision
{revision}), and would be different elsewhere. **Section evaluations**, how often the equations of a rod's cross-section were evaluated, are the
same on every machine: compare methods by them. (Strain and collocation evaluate larger sections of algebra between
them, so one evaluation stands for more work there than in shooting.)

How a scene chooses: `<accuracy>` asks for an error and leaves the rest to the program, here the line `accuracy`, with
the pilots by which the program finds out what to choose (the figure is of any link or rod, so that one channel's error is
smaller); `<time scheme= tolerance=>` or
`step=`, `<space points=>` say it exactly; `--set scheme=esdirk43 --set tolerance=1e-6 --set points=6` does on the
command line. Steps: `backward_euler` is of first order, `bdf2`, `bdf_alpha`, `generalized_alpha`, `tr_bdf2` of second,
`esdirk32` of third, `esdirk43` of fourth, `radau5` of fifth; `tr_bdf2`, `esdirk32`, `esdirk43` and `ida`, of variable order,
can adapt their step to a tolerance. In space, `points` are
cells of Gauss collocation of order 6 along each rod.
"""


def machine():
    model, count = "an unnamed processor", 0
    with open("/proc/cpuinfo") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                count += 1
    return f"{model}, {count} logical processors"


def seconds(x):
    return f"{x:.3g} s" if x >= 0.1 else f"{1e3 * x:.3g} ms"


def settings(run):
    return ", ".join(f"{name} {value}" for name, value in run["settings"].items() if name != "residual")


def decades_table(report):
    unit = report["measures"][0]["unit"]
    rows = ["| error at most | cheapest setting | error | CPU | steps | section evaluations |",
            "|---|---|---|---|---|---|"]
    for decade in report["decades"]:
        run = report["runs"][decade["run"]]
        rows.append(f"| 1e{round(math.log10(decade['bound']))} {unit} | {settings(run)} | {run['errors'][0]:.1e} | "
                    f"{seconds(run['cpu_seconds'])} | {run['steps']} | {run['section_evaluations']} |")
    return "\n".join(rows)


def methods_table(report):
    """The cheapest run of each scheme or method for each error, in section evaluations and time."""
    unit = report["measures"][0]["unit"]
    done = [run for run in report["runs"] if run["status"] == "done"]
    bounds = [decade["bound"] for decade in report["decades"]]

    def family(run):
        s = run["settings"]
        if "accuracy" in s:
            return "accuracy, with its pilots"
        how = s.get("scheme", s.get("integrator", ""))
        how += " adaptive" if "tolerance" in s and "scheme" in s else ""
        return ", ".join(part for part in (s.get("method", ""), how) if part)

    families = list(dict.fromkeys(family(run) for run in done))
    rows = ["| | " + " | ".join(f"1e{round(math.log10(b))} {unit}" for b in bounds) + " |",
            "|---|" + "---|" * len(bounds)]
    for name in families:
        cells = []
        for bound in bounds:
            good = [r for r in done if family(r) == name and r["errors"][0] <= bound]
            best = min(good, key=lambda r: r["section_evaluations"], default=None)
            cells.append(f"{best['section_evaluations']} ({seconds(best['cpu_seconds'])})" if best else "")
        rows.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(rows)


def orders_text(report):
    """Orders seen between the two finest runs of each line that shows one."""
    seen = {}
    for run in report["runs"]:
        if "order" in run:
            seen[run["line"]] = run["order"]
    if not seen:
        return ""
    return "Orders seen between the two finest runs of each line (small where the error of the other resolution remains): " + "; ".join(
        f"{line} {order:.1f}" for line, order in seen.items()) + ".\n"


def failures_text(report):
    failed = [run for run in report["runs"] if run["status"] == "failed"]
    refused = [run for run in report["runs"] if run["status"] == "refused"]
    text = f"{len(report['runs']) - len(failed) - len(refused)} runs"
    if failed:
        text += f"; {len(failed)} failed: " + "; ".join(settings(run) for run in failed[:6])
        text += ", ..." if len(failed) > 6 else ""
    if refused:
        text += f"; {len(refused)} are not available ({refused[0].get('reason', '')})"
    return text + "."


def section(program, scene, options, about, folder, quick):
    name = os.path.splitext(os.path.basename(scene))[0]
    with tempfile.TemporaryDirectory() as scratch:
        out = os.path.join(scratch, "sweep")
        words = [program, "sweep", scene, "--sweep", "all", *options, "-o", out, "-q", "--progress", "none"]
        if quick and "--quick" not in words:
            words.append("--quick")
        print(" ".join(words[1:]), flush=True)
        subprocess.run(words, check=True)
        with open(os.path.join(out, "sweep.json")) as file:
            report = json.load(file)
        for kind in ("svg", "csv"):
            shutil.copy(os.path.join(out, "sweep." + kind), os.path.join(folder, "accuracy", f"{name}_sweep.{kind}"))
    unit = report["measures"][0]["unit"]
    shown = " ".join(["cprsim sweep", scene, "--sweep all", *options])
    return "\n".join([
        f"## {name}", "", about, "", f"**{report['words']}**", "", f"![Error against cost](accuracy/{name}_sweep.svg)", "",
        f"`{shown}`: {failures_text(report)} Errors of `{report['measures'][0]['name']}` against {report['reference']}, "
        f"itself known to {report['reference_spread'][0]:.1e} {unit}; rods are {report['longest_rod']:g} m long. All "
        f"numbers: [{name}_sweep.csv](accuracy/{name}_sweep.csv).", "",
        decades_table(report), "", "Section evaluations (and CPU time) that each scheme and method needs:", "",
        methods_table(report), "", orders_text(report)])


def main():
    arguments = [word for word in sys.argv[1:] if word != "--quick"]
    quick = "--quick" in sys.argv
    if len(arguments) != 2:
        raise SystemExit(__doc__)
    program, folder = arguments
    os.makedirs(os.path.join(folder, "accuracy"), exist_ok=True)
    command = "python3 tests/bench/accuracy_page.py build/bin/cprsim docs" + (" --quick" if quick else "")
    revision = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
    page = PREFACE.format(command=command, machine=machine(), revision=re.sub(r".*\((\S+?),.*", r"\1", revision.strip()))
    for scene, options, about in SCENES:
        page += "\n" + section(program, scene, options, about, folder, quick)
    page += ("\n## See also\n\nWhether an accuracy that is asked for is kept: [accuracy_kept.md](accuracy_kept.md). "
             "The released rod with an independent reference, solved by another program: "
             "[accuracy/released_rod.md](accuracy/released_rod.md).\n")
    with open(os.path.join(folder, "accuracy.md"), "w") as file:
        file.write(page)


if __name__ == "__main__":
    main()
