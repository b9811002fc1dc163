#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a step costs that touches something: docs/contact_costs.md.

    python3 tests/bench/contact_costs.py build/bin/cprsim docs/contact_costs.md

A clamped steel rod is pressed on a shape by a force at its tip that swells and ebbs, 300 steps of BDF2. The same with
the shape out of reach, and without the effect. Times are the fastest of five runs, taken by turns.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

REPEATS = 5
RIDGE = """v -0.02 -0.1 -0.04
v 0.02 -0.1 -0.04
v 0 -0.1 0
v -0.02 0.1 -0.04
v 0.02 0.1 -0.04
v 0 0.1 0
f 1 2 3
f 4 6 5
f 1 4 5
f 1 5 2
f 2 5 6
f 2 6 3
f 3 6 4
f 3 4 1
"""
# geometry, and the height of its frame when its top is at 0
SHAPES = {
    "plane": ("<plane><normal>0 0 1</normal></plane>", 0, ""),
    "box": ("<box><size>0.04 0.4 0.04</size></box>", -0.02, ""),
    "sphere": ("<sphere><radius>0.02</radius></sphere>", -0.02, ""),
    "cylinder": ("<cylinder><radius>0.02</radius><length>0.4</length></cylinder>", -0.02, "1.5707963267948966 0 0"),
    "capsule": ("<capsule><radius>0.02</radius><length>0.4</length></capsule>", -0.02, "1.5707963267948966 0 0"),
    "cone": ("<cone><radius>0.05</radius><length>0.05</length></cone>", -0.025, ""),
    "ellipsoid": ("<ellipsoid><radii>0.02 0.06 0.03</radii></ellipsoid>", -0.03, ""),
    "mesh": ("<mesh><uri>ridge.obj</uri></mesh>", 0, ""),
}


def scene(geometry, height, turn, rods, effect, across=False):
    """One rod beside the other, 20 mm apart; the shape's top `height` above the first rod's underside."""
    contact = "<contact/><friction/>" if effect else ""
    shape = f"""<model name="scenery"><static>true</static><link name="shape"><pose>0.25 0 {height} {turn or "0 0 0"}</pose>
      <collision name="c"><geometry>{geometry}</geometry><surface><friction><ode><mu>0.3</mu></ode></friction></surface></collision>
      </link></model>""" if geometry else ""
    crossing = f"""<frame name="beside"><pose>0.25 -0.25 {height} -1.5707963267948966 0 0</pose></frame>
      <cprsim:rod name="across" class="steel"><base attached_to="beside" joint="fixed"/><length>0.5</length></cprsim:rod>""" if across else ""
    beams = "".join(f"""<frame name="clamp_{k}"><pose>0 {0.02 * (k - 0.5 * (rods - 1))} 0 0 1.5707963267948966 0</pose></frame>
      <cprsim:rod name="beam_{k}" class="steel"><base attached_to="clamp_{k}" joint="fixed"/><length>0.5</length></cprsim:rod>
      <cprsim:load at="beam_{k}(s=1)"><force>0 0 -3</force></cprsim:load>
      <cprsim:load at="beam_{k}(s=1)"><force>0 0 -1</force><sine amplitude="1" frequency="4"/></cprsim:load>""" for k in range(rods))
    return f"""<?xml version="1.0"?>
<sdf version="1.11" xmlns:cprsim="urn:cprsim:1"><world name="cost">
  <gravity>0 0 -9.81</gravity>
  <physics name="default" type="bullet"><max_step_size>0.001</max_step_size>
    <cprsim:solver method="shooting"><space points="16" integrator="gauss6"/><time scheme="bdf2"/></cprsim:solver></physics>
  <cprsim:simulation mode="dynamic"><duration>0.3</duration><initial solve="static"/></cprsim:simulation>
  <cprsim:effects><gravity/>{contact}</cprsim:effects>
  {shape}
  <model name="rods"><static>true</static><link name="wall"/>
    <cprsim:rod_class name="steel"><cross_section><circle><radius>0.002</radius></circle></cross_section>
      <material><density>7850</density><youngs_modulus>200e9</youngs_modulus><poisson_ratio>0.3</poisson_ratio></material>
      <surface><friction><ode><mu>1</mu></ode></friction></surface></cprsim:rod_class>
    {beams}{crossing}
  </model>
</world></sdf>
"""


class Cost:
    def __init__(self, text):
        self.text, self.time, self.count, self.forces = text, float("inf"), {}, 0

    def run(self, program, folder):
        (folder / "scene.xml").write_text(self.text)
        out = folder / "out"
        answer = subprocess.run([program, "run", folder / "scene.xml", "-q", "-o", out], capture_output=True, text=True)
        if answer.returncode != 0:
            sys.exit(answer.stderr)
        result = json.loads((out / "run.json").read_text())
        self.count = result["statistics"]
        self.time = min(self.time, 1e6 * result["timings"]["steps"] / self.count["steps"])

    def per_step(self, what):
        return self.count[what] / self.count["steps"]


def measure(program, cases):
    """cases: name -> (never touches, touches, without the effect)"""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "ridge.obj").write_text(RIDGE)
        for _ in range(REPEATS):
            for row in cases.values():
                for cost in row:
                    cost.run(program, folder)
    return cases


def row(shape, rods=1, across=False):
    geometry, top, turn = SHAPES[shape] if shape else ("", 0, "")
    gap = -0.004  # of the top from the axis: the rod must sag by 2 mm
    return [Cost(scene(geometry, z, turn, rods, effect, across))
            for z, effect in ((top + gap - 0.3, False), (top + gap - 0.3, True), (top + gap, True))]


def table(cases, head):
    text = (f"| {head} | without the effect, us a step | out of reach | touching, us a step | of it without | "
            "iterations a step, free | touching |\n|---|---|---|---|---|---|---|\n")
    for name, (plain, far, near) in cases.items():
        text += (f"| {name} | {plain.time:.0f} | x {far.time / plain.time:.2f} | {near.time:.0f} | "
                 f"x {near.time / plain.time:.2f} | {plain.per_step('iterations'):.1f} | "
                 f"{near.per_step('iterations'):.1f} |\n")
    return text


def main():
    program, page = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    shapes = measure(program, {name: row(name) for name in SHAPES} | {"another rod": row("", across=True)})
    rods = measure(program, {str(n): row("plane", n) for n in (1, 2, 4, 8, 16)})
    page.write_text(f"""# What contact costs

`python3 tests/bench/contact_costs.py build/bin/cprsim docs/contact_costs.md`

A clamped steel rod of 0.5 m and 2 mm radius, 16 cells, is pressed on a shape by a force at its tip, 300 steps of BDF2 of 1 ms. Out
of reach: the same with the shape 0.3 m lower. Times are the fastest of {REPEATS} runs each; iterations do not depend on the machine.

{table(shapes, "shape")}
Side by side on a plane, none touching the next:

{table(rods, "rods")}""")


if __name__ == "__main__":
    main()
