#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the tests that tests/stability/catalogue.txt names and writes what they measured as a page.

    python3 tests/stability/page.py build/bin docs/stability.md
"""
import json
import os
import subprocess
import sys
import tempfile

CATALOGUE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "catalogue.txt")
OTHER_METHODS = ["strain", "collocation"]  # than shooting, which is what a scene gets by itself
ANY_METHOD = "stability_test"  # whose tests take any
CONTACT = "Touch."  # takes the other methods minutes, and is theirs in contact_laws_test
PARTS = {"N": "Numerical", "I": "Input", "S": "System"}


def rows():
    with open(CATALOGUE) as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                yield [part.strip() for part in line.split("|")]


def matches(test, pattern):
    """Whether a test as gtest names it, with the prefix and suffix of its parameter, is the Suite.Test of the pattern."""
    suite, _, name = test.partition(".")
    suite = suite.split("/")[-1]
    wanted_suite, _, wanted_name = pattern.partition(".")
    return suite == wanted_suite and wanted_name in ("*", name.split("/")[0])


def run(folder, program, patterns, method=None):
    """Every test of the program that a pattern names -> (passed, [(what, value, limit)])."""
    variables = dict(os.environ, CPRSIM_TEST_METHOD=method) if method else None
    filters = ":".join(p + ":*/" + p + "/*" for p in patterns)
    with tempfile.TemporaryDirectory() as scratch:
        out = os.path.join(scratch, "out.json")
        subprocess.run([os.path.join(folder, program), "--gtest_filter=" + filters, "--gtest_output=json:" + out],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=variables)
        with open(out) as file:
            results = json.load(file)
    tests = {}
    for suite in results["testsuites"]:
        for test in suite["testsuite"]:
            measured = []
            for what, text in test.items():
                words = text.split() if isinstance(text, str) else []
                try:
                    measured.append((what, *map(float, words)) if len(words) == 2 else None)
                except ValueError:
                    measured.append(None)
            tests[suite["name"] + "." + test["name"]] = ("failures" not in test, [m for m in measured if m])
    return tests


def margin(value, limit):
    return "∞" if value <= 0 else f"{limit / value:.2g}" if limit > 0 else "0"


def main(folder, page):
    wanted = {}
    for _, _, tests in rows():
        for name in [] if tests.startswith("-") else tests.split(","):
            program, _, pattern = name.strip().partition(":")
            wanted.setdefault(program, set()).add(pattern)
    results = {program: run(folder, program, sorted(patterns)) for program, patterns in wanted.items()}
    free = sorted(p for p in wanted[ANY_METHOD] if not p.startswith(CONTACT))
    by_method = {method: run(folder, ANY_METHOD, free, method) for method in OTHER_METHODS}

    def verdict(method, tests):
        """Of the row's tests that take any method; nothing if there is none."""
        patterns = [p for q, _, p in (n.strip().partition(":") for n in tests.split(",")) if q == ANY_METHOD and p in free]
        found = [r for p in patterns for t, r in by_method[method].items() if matches(t, p)]
        if all(ok for ok, _ in found):
            return "passes" if found else ""
        worst = [f"{what}: {value:g} of {limit:g}" for ok, list_ in found if not ok for what, value, limit in list_ if value > limit]
        return "**beyond**: " + ("<br>".join(worst) or "a condition of the test that is no number")

    lines, part, failed = [], "", 0
    for row, asks, tests in rows():
        if PARTS[row[0]] != part:
            part = PARTS[row[0]]
            lines += ["", "## " + part, "", "| case | what it asks | result | by strain basis | by collocation | measured, limit, margin | test |",
                      "|---|---|---|---|---|---|---|"]
        if tests.startswith("-"):
            lines.append(f"| {row} | {asks} | not in this version: {tests[1:].strip()} | | | | |")
            continue
        names, passed, measured = [], True, []
        for name in tests.split(","):
            program, _, pattern = name.strip().partition(":")
            found = [r for t, r in results[program].items() if matches(t, pattern)]
            passed = passed and bool(found) and all(ok for ok, _ in found)
            measured += [m for _, list_ in found for m in list_]
            names.append(f"`{pattern}`")
        failed += not passed
        numbers = "<br>".join(f"{what}: {value:g} of {limit:g}, {margin(value, limit)}" for what, value, limit in measured)
        lines.append(f"| {row} | {asks} | {'passes' if passed else '**fails**'} | "
                     f"{' | '.join(verdict(m, tests) for m in OTHER_METHODS)} | {numbers} | {'<br>'.join(names)} |")
    with open(page, "w") as file:
        file.write("# Hard cases\n\nMade by `python3 tests/stability/page.py build/bin docs/stability.md`. Every case is "
                   "an automatic test; where physics has an answer, the test knows it. The margin is how many times "
                   "smaller the measured number is than its limit. Rods are solved by shooting unless a test says otherwise; "
                   "where it says nothing, and nothing touches, the same test is made by the other methods as well, with the "
                   "same limits (`CPRSIM_TEST_METHOD=strain build/bin/stability_test`); **beyond** says which number exceeds them.\n" + "\n".join(lines) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
