#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What `cprsim info` estimates of each effect's absence or presence beside what `cprsim effects` measures.

    python3 tests/effects/estimates_page.py build/bin/cprsim docs/effects.md

writes the table between the marks of the page. With --check nothing is written: it fails if an estimate is wrong by more
than FACTOR where what is measured is above the noise, or if too few are compared.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

FACTOR = 5
NOISE = 10  # times what the runs themselves err by
BEGIN, END = "<!-- estimates: begin -->", "<!-- estimates: end -->"
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ["mechanics/cantilever_end_moment", "loads/on_springs", "rods/clothoid", "rods/coated", "rods/stepped", "rods/tapered",
          "effects/bimetal", "effects/magnetic_cantilever", "effects/steered_tip", "fluid/wire_in_a_river",
          "tendons/parallel_tendon", "tendons/till_tendon_robot", "robots/planar_two_rods", "robots/csg_clamped",
          "robots/planar_2rr", "robots/spatial_3pfr", "robots/stewart_gough_6ffr", "mechanics/released_rod",
          "fluid/released_rod_in_water"]


def answer(program, *words):
    done = subprocess.run([program, *words, "--json", "--quiet"], stdout=subprocess.PIPE, check=True, cwd=ROOT)
    return json.loads(done.stdout)


def compared(program, scene):
    """(effect, listed, estimate, by, measured) of all that both know, lengths over the longest rod."""
    path = f"scenes/{scene}.xml"
    estimates = answer(program, "info", path)["estimates"]
    with tempfile.TemporaryDirectory() as folder:
        measured = answer(program, "effects", path, "-o", folder + "/out")
    assert measured["measure"] == estimates["watched"], (measured["measure"], estimates["watched"])
    length, error = measured["longest_rod"], measured["numerical_error"]
    changes = {row["effect"]: row["change"] for row in measured["rows"] if "change" in row}
    rows = []
    for one in estimates["effects"]:
        if "change" in one and one["effect"] in changes:
            rows.append((one["effect"], one["listed"], one["change"], one["by"], changes[one["effect"]] / length,
                         changes[one["effect"]] > NOISE * error))
    return rows, error / length


def main():
    program, page = sys.argv[1], pathlib.Path(sys.argv[2])
    check = "--check" in sys.argv[3:]
    lines = ["| scene | effect | estimated | by | measured | estimated / measured |", "|---|---|---|---|---|---|"]
    worst, count, wrong = 1.0, 0, []
    for scene in SCENES:
        rows, error = compared(program, scene)
        for effect, listed, estimate, by, measured, above in rows:
            what = ("without " if listed else "with ") + effect
            if not above:
                if estimate > FACTOR * max(measured, NOISE * error):
                    wrong.append(f"{scene}, {what}: {estimate:.2g} estimated, below {NOISE * error:.2g} measured")
                continue
            # what moves by lengths is told as one length
            ratio = estimate / min(measured, 1)
            count += 1
            worst = max(worst, ratio, 1 / ratio if ratio > 0 else float("inf"))
            if not 1 / FACTOR <= ratio <= FACTOR:
                wrong.append(f"{scene}, {what}: {estimate:.2g} estimated, {measured:.2g} measured")
            lines.append(f"| {scene.split('/')[1]} | {what} | {estimate:.1e} | {by} | {measured:.1e} | {ratio:.2g} |")
    for line in wrong:
        print(line)
    if check:
        print(f"{count} estimates compared, the worst is wrong by a factor of {worst:.2g}")
        return 1 if wrong or count < 20 else 0
    text = page.read_text(encoding="utf-8")
    head, rest = text.split(BEGIN)
    tail = rest.split(END)[1]
    page.write_text(head + BEGIN + "\n" + "\n".join(lines) + "\n" + END + tail, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
