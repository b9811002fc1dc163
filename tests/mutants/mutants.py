#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do the tests notice when the solver is wrong? Changes one line at a time, as tests/mutants/table.txt says, in a copy of the
sources, builds the tests that the table names and runs them until one fails. What has been killed is not tried again: a run
that was interrupted goes on, and what lived gets another chance.

    python3 tests/mutants/mutants.py [--folder build-mutants] [--jobs N] [--page docs/mutants.md] [--only TEXT]
"""
import argparse
import hashlib
import json
import os
import subprocess
import time

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "table.txt")
SETTINGS = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O1", "-DCPRSIM_UNITY=OFF",
            "-DCPRSIM_BENCHMARKS=OFF", "-DCPRSIM_WERROR=OFF"]


class Mutant:
    def __init__(self, header, old, new):
        self.file, _, tests = header.partition(":")
        self.tests = tests.split()
        self.old, self.new = old, new

    def applied(self, text):
        if text.count(self.old) != 1:
            raise SystemExit(f"{self.file}: '{self.old}' stands there {text.count(self.old)} times, not once")
        return text.replace(self.old, self.new)

    def key(self, text):
        """Of the change in what stands there now."""
        return hashlib.sha256("\0".join([self.applied(text), *self.tests]).encode()).hexdigest()[:16]


def read_table():
    blocks = [[]]
    with open(TABLE) as file:
        for line in file:
            if line.startswith("#"):
                continue
            if line.strip():
                blocks[-1].append(line.rstrip("\n"))
            elif blocks[-1]:
                blocks.append([])
    mutants = []
    for block in filter(None, blocks):
        header, old, new = block
        assert old.startswith("- ") and new.startswith("+ "), block
        mutants.append(Mutant(header, old[2:], new[2:]))
    return mutants


def read(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, content):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(content)


def copy_sources(to):
    """Leaves what is the same untouched, lest it be built again."""
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True,
                           check=True).stdout.split("\n")
    for name in filter(None, names):
        if not os.path.isfile(os.path.join(ROOT, name)):
            continue
        content = read(os.path.join(ROOT, name))
        target = os.path.join(to, name)
        if not os.path.exists(target) or read(target) != content:
            write(target, content)


class Bench:
    def __init__(self, folder, jobs):
        self.source, self.build = os.path.join(folder, "source"), os.path.join(folder, "build")
        self.jobs = jobs
        self.log = open(os.path.join(folder, "log.txt"), "a")

    def made(self, tests):
        return subprocess.run(["ninja", "-C", self.build, f"-j{self.jobs}", *tests], stdout=self.log,
                              stderr=self.log).returncode == 0

    def failure(self, test, most):
        """The first test of a program that fails, or None."""
        try:
            run = subprocess.run([os.path.join(self.build, "bin", test), "--gtest_fail_fast", "--gtest_color=no"],
                                 capture_output=True, text=True, timeout=most, errors="replace")
        except subprocess.TimeoutExpired:
            return test + ", which does not end"
        if run.returncode == 0:
            return None
        failed = [line for line in run.stdout.split("\n") if line.startswith("[  FAILED  ] ") and "." in line]
        return failed[0][len("[  FAILED  ] "):].split(" (")[0].split(",")[0] if failed else test + ", which ends early"

    def verdict(self, mutant, limits):
        path = os.path.join(self.source, mutant.file)
        right = read(path)
        write(path, mutant.applied(right.decode()).encode())
        try:
            if not self.made(mutant.tests):
                return "not built", ""
            for test in mutant.tests:
                found = self.failure(test, limits[test])
                if found:
                    return "killed", found
            return "alive", ""
        finally:
            write(path, right)


def page_of(rows):
    killed = sum(verdict == "killed" for _, verdict, _ in rows)
    lines = ["# Whether the tests notice when the solver is wrong", "",
             f"Each row changes one line of the solver; {killed} of {len(rows)} changes are noticed by the tests. Made by "
             "`python3 tests/mutants/mutants.py --page docs/mutants.md`, which takes the changes from "
             "[tests/mutants/table.txt](../tests/mutants/table.txt), one after the other, and runs the test programs named "
             "there until one fails.", "",
             "| file | instead of | stands | | first test that fails |", "|---|---|---|---|---|"]
    for mutant, verdict, by in rows:
        cells = [mutant.old.strip(), mutant.new.strip()]
        old, new = (f"`{cell.replace('|', chr(92) + '|')}`" for cell in cells)
        lines.append(f"| {mutant.file} | {old} | {new} | {verdict} | {by} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", default=os.path.join(ROOT, "build-mutants"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--page")
    parser.add_argument("--only", default="", help="mutants whose file or lines hold this text")
    words = parser.parse_args()
    os.nice(19)
    mutants = [m for m in read_table() if words.only in m.file or words.only in m.old or words.only in m.new]
    os.makedirs(words.folder, exist_ok=True)
    known_path = os.path.join(words.folder, "verdicts.json")
    known = json.loads(read(known_path)) if os.path.exists(known_path) else {}
    bench = Bench(words.folder, words.jobs)
    copy_sources(bench.source)
    keys = [m.key(read(os.path.join(bench.source, m.file)).decode()) for m in mutants]
    open_ones = [m for m, key in zip(mutants, keys) if known.get(key, [""])[0] != "killed"]

    if open_ones:
        subprocess.run(["cmake", "-S", bench.source, "-B", bench.build, *SETTINGS], stdout=bench.log, check=True)
        tests = sorted({test for m in open_ones for test in m.tests})
        if not bench.made(tests):
            raise SystemExit(f"the tests cannot be built: {words.folder}/log.txt")
        limits = {}
        for test in tests:
            begin = time.time()
            if bench.failure(test, 3600):
                raise SystemExit(f"{test} fails without any change")
            limits[test] = 60 + 10 * (time.time() - begin)
    rows = []
    for mutant, key in zip(mutants, keys):
        if mutant in open_ones:
            known[key] = bench.verdict(mutant, limits)
            write(known_path, json.dumps(known, indent=1).encode())
        verdict, by = known[key]
        rows.append((mutant, verdict, by))
        print(f"{len(rows):3} {verdict:9} {mutant.file}: {mutant.new.strip()}  {by}", flush=True)
    killed = sum(verdict == "killed" for _, verdict, _ in rows)
    print(f"{killed} of {len(rows)} killed")
    if words.page:
        write(os.path.abspath(words.page), page_of(rows).encode())


if __name__ == "__main__":
    main()
