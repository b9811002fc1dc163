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
]

# Where `<accuracy>` is held against a run of which a hundredth of the error is asked.
ASKED = [
    ("scenes/mechanics/released_rod.xml", ["--duration", "0.5"]),
    ("scenes/mechanics/joints.xml", ["--duration", "0.2"]),
    ("scenes/robots/planar_2pr.xml", ["--duration", "1"]),
    ("scenes/robots/stewart_gough.xml", ["--duration", "0.5"]),
    ("scenes/robots/slider_crank.xml", ["--duration", "0.5"]),
    ("scenes/robots/planar_rfrfr.xml", ["--duration", "0.5"]),
    ("scenes/robots/spatial_3pfr.xml", ["--duration", "0.5"]),
    ("scenes/robots/csg_published.xml", []),
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

How a scene chooses: `<accuracy>` asks for an error and leaves the rest to the program; `<time scheme= tolerance=>` or
`step=`, `<space points=>` say it exactly; `--set scheme=esdirk43 --set tolerance=1e-6 --set points=6` does on the
command line. Steps: `backward_euler` is of first order, `bdf2`, `bdf_alpha`, `generalized_alpha`, `tr_bdf2` of second,
`esdirk32` of third, `esdirk43` of fourth; the last three can adapt their step to a tolerance. In space, `points` are
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


def run_asked(program, scene, options, asked, out):
    words = [program, "run", scene, *options, "--no-video", "-qq", "--accuracy", repr(asked), "-o", out]
    code = subprocess.run(words, stderr=subprocess.DEVNULL).returncode
    if code not in (0, 1):  # 1: what the scene expects is about another accuracy
        raise SystemExit(" ".join(words) + f": exit code {code}")
    with open(os.path.join(out, "run.json")) as file:
        return json.load(file)


def largest_error(program, a, b, scratch):
    """Of all recorded positions, in m; nothing if none was recorded."""
    table = next(file["name"] for file in b["files"] if file["kind"] == "csv")
    words = [program, "compare", os.path.join(scratch, "asked"), os.path.join(scratch, "tight", table), "--json", "-o",
             os.path.join(scratch, "compared")]
    report = json.loads(subprocess.run(words, check=True, capture_output=True).stdout)
    # not points between a rod's nodes, which are interpolated
    errors = [q["max"] for q in report["quantities"]
              if q["name"].endswith("position") and q["unit"] == "m" and "(s=" not in q["name"]]
    return max(errors, default=None)


def accuracy_section(program, quick):
    rows = ["## What `<accuracy>` keeps", "",
            "`<accuracy>1e-5</accuracy>`, or `--accuracy 1e-5`, lets the program choose resolution and steps. It runs the "
            "scene twice, the first time with ten times the error asked for; a third of the largest distance between "
            "the two, over all links and tips of rods, is reported as the error of the second, and the scene is "
            "run again with finer settings while that is more than what was asked. Here the report is held against a run "
            "asked to be a hundred times more accurate, at all recorded positions of links, joints and tips. Runs counts all of them, the last "
            "column how many section evaluations the search cost beside the last run. Where the run stays far below what was asked "
            "it is because rods have three cells at least; 'same cells': the tighter run was no different. Bold: an accuracy "
            "that is not kept, or an error that is reported less than half as large as it is. That happens at loose "
            "accuracies, where the looser run takes the same few steps.", "",
            "| scene | asked [m] | reported [m] | true [m] | asked / true | runs | search / run |", "|---|---|---|---|---|---|---|"]
    for scene, options in ASKED[:2] if quick else ASKED:
        for asked in (1e-3, 1e-5) if quick else (1e-3, 1e-4, 1e-5, 1e-6):
            with tempfile.TemporaryDirectory() as scratch:
                run = run_asked(program, scene, options, asked, os.path.join(scratch, "asked"))
                tight = run_asked(program, scene, options, asked / 100, os.path.join(scratch, "tight"))
                error = largest_error(program, run, tight, scratch)
            if error is None:
                continue
            found = run["accuracy"]
            counted = run["statistics"]["section_evaluations"]  # none where nothing is elastic
            search = f"{found['section_evaluations_before'] / counted:.2g}" if counted else ""
            kept = f"{asked / error:.2g}" if error > 0 else ""
            name = os.path.splitext(os.path.basename(scene))[0]
            reported = f"{found['estimate']:.1e}"
            if error > 2 * found["estimate"]:
                reported = f"**{reported}**"
            true = f"{error:.1e}" if error > 0 else "same cells"
            rows.append(f"| {name} | {asked:.0e} | {reported} | {true} | "
                        f"{kept if error <= asked else '**' + kept + '**'} | {found['runs']} | {search} |")
            print(rows[-1], flush=True)
    return "\n".join(rows) + "\n"


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
    page += "\n" + accuracy_section(program, quick)
    page += ("\n## See also\n\nThe released rod with an independent reference, solved by another program: "
             "[accuracy/released_rod.md](accuracy/released_rod.md).\n")
    with open(os.path.join(folder, "accuracy.md"), "w") as file:
        file.write(page)


if __name__ == "__main__":
    main()
