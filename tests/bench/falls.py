#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Falls of a loose rope on a floor: how many run to their end, how deep it sinks, what energy is not accounted for.

    python3 tests/bench/falls.py build/bin/cprsim            # 144 falls, two at a time: minutes

scenes/contact/falling_rope.xml with other cells, pitch, modulus and friction. A fall that takes more than a minute counts as
one that does not run to its end.
"""
import concurrent.futures
import itertools
import json
import pathlib
import sys
import tempfile
import subprocess

CELLS, PITCHES, MODULI, FRICTION = (4, 12, 24, 48), (0.3, 0.8, 1.2, 1.5), (1e6, 3e7, 1e9), (0, 0.3, 1)
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes/contact/falling_rope.xml"


def fall(program, case, folder):
    cells, pitch, modulus, friction = case
    text = SCENE.read_text()
    for old, new in (('points="24"', f'points="{cells}"'), ("0 0 0.3 0 1.2 0", f"0 0 0.3 0 {pitch} 0"),
                     ("<mu>0.3</mu>", f"<mu>{friction}</mu>"), ("5e6</youngs", f"{modulus}</youngs"),
                     ("2e6</shear", f"{0.4 * modulus}</shear")):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    text = text[:text.index("<cprsim:expect")] + "</world></sdf>"
    at = folder / "_".join(str(x) for x in case)
    at.mkdir()
    (at / "scene.xml").write_text(text)
    answer = subprocess.run([program, "run", at / "scene.xml", "--no-video", "--max-wall", "60", "-q", "-o", at / "out"],
                            capture_output=True, text=True)
    result = json.loads((at / "out/run.json").read_text())
    radius, energy = 0.004, result["energy"]
    return {"case": case, "code": answer.returncode, "reached": result["time"],
            "deep": result["largest_penetration"] / radius,
            "made": max(0, energy["balance"]) / max(energy["exchanged"], 1e-12),
            "message": answer.stderr.split("\n")[0]}


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(2) as pool:
        falls = list(pool.map(lambda case: fall(program, case, pathlib.Path(name)),
                              itertools.product(CELLS, PITCHES, MODULI, FRICTION)))
    # warnings end with 0 or 1, runs that stop with 4
    ended = [f for f in falls if f["code"] != 4]
    for f in falls:
        if f["code"] == 4:
            cells, pitch, modulus, friction = f["case"]
            print(f"{cells} cells, pitch {pitch}, E {modulus:g} Pa, mu {friction}: {f['reached']:.3f} s: {f['message']}")
    print(f"{len(ended)} of {len(falls)} falls run to their end")
    for cells in CELLS:
        deep = max(f["deep"] for f in ended if f["case"][0] == cells)
        print(f"{cells} cells: sinks {deep:.2g} r at most")
    print(f"energy made: {max(f['made'] for f in ended):.1e} of what moved, at most")


if __name__ == "__main__":
    main()
