#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Puts the known fault of a hard case back into the trainer, one at a time, and demands that the case's test fails.

hard_cases.toml lists the faults. Works on a copy of the project, in which test_hard_cases is built once and then
again with each fault. Ends with 0 if every fault was caught by the test of its own case.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib

here = pathlib.Path(__file__).resolve().parent
repository = here.parent.parent
sys.path.insert(0, str(repository / "scripts"))
import source_marks  # noqa: E402

trainer = "examples/gaussian_splatting"
parts = ["CMakeLists.txt", "cmake", "include", "examples", "tests"]
run_limit = 300  # seconds


def edits(mutation):
    return mutation.get("edit", [{"at": mutation["name"], **mutation}])


class Copy:
    """A copy of the project, and its build."""

    def __init__(self, folder):
        self.source, self.build_folder = folder / "source", folder / "build"
        self.source.mkdir()
        for part in parts:
            copy = shutil.copytree if (repository / part).is_dir() else shutil.copy
            copy(repository / part, self.source / part)
        self.do("cmake", "-S", self.source, "-B", self.build_folder, "-G", "Ninja", "-DWARPAGG_CUDA=OFF",
                "-DWARPAGG_FULL_TESTS=ON", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -w")

    def do(self, *command):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(done.stdout[-2000:] + done.stderr[-2000:])

    def build(self):
        self.do("ninja", "-C", self.build_folder, "test_hard_cases")

    def fails(self, case):
        """How the test of a case fails; None if it passes."""
        program = self.build_folder / "tests" / "test_hard_cases"
        try:
            done = subprocess.run([program, f"--test-case=case {case}:*"], capture_output=True, text=True,
                                  timeout=run_limit)
        except subprocess.TimeoutExpired:
            return "hangs"
        if done.returncode == 0:
            return None
        summary = [line for line in done.stdout.splitlines() if "assertions:" in line]
        return summary[-1].strip() if summary else f"ends with {done.returncode}"

    def with_fault(self, mutation):
        file = source_marks.find_marks(self.source / trainer, "mutate")[edits(mutation)[0]["at"]]
        sound = file.read_text()
        file.write_text(source_marks.edited(sound, "mutate", edits(mutation)))
        try:
            self.build()
            return self.fails(mutation["case"])
        finally:
            file.write_text(sound)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="NAME", action="append", help="this one alone; may be repeated")
    parser.add_argument("--check", action="store_true", help="check the marks in the sources and stop")
    arguments = parser.parse_args()
    only = arguments.only
    mutations = tomllib.loads((here / "hard_cases.toml").read_text())["mutation"]
    try:
        source_marks.check(source_marks.find_marks(repository / trainer, "mutate"),
                           [e["at"] for m in mutations for e in edits(m)], "mutate")
    except source_marks.MarkError as error:
        sys.exit(str(error))
    if arguments.check:
        return
    if only:
        if unknown := set(only) - {m["name"] for m in mutations}:
            sys.exit(f"no mutation is named {', '.join(unknown)}")
        mutations = [m for m in mutations if m["name"] in only]
    with tempfile.TemporaryDirectory(prefix="warpagg-mutation-") as folder:
        copy = Copy(pathlib.Path(folder))
        copy.build()
        for case in sorted({m["case"] for m in mutations}):
            if how := copy.fails(case):
                sys.exit(f"without any fault, case {case} fails: {how}")
        survivors = 0
        for m in mutations:
            start = time.monotonic()
            how = copy.with_fault(m)
            survivors += how is None
            print(f"case {m['case']:2}  {m['name']:32} {time.monotonic() - start:4.0f} s  {how or 'SURVIVES'}", flush=True)
    print(f"{len(mutations) - survivors} of {len(mutations)} caught")
    sys.exit(1 if survivors else 0)


if __name__ == "__main__":
    main()
