#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Puts one fault at a time into a copy of the headers and demands that the suite notices it.

mutations.toml lists the faults, each with the one test program that must fail. A test of a policy that must not
compile (compile_fail/) fails by compiling; cuda/test_ptx.cpp needs nvcc and is skipped without. Every program must
first pass with the headers as they are. The compiler is $CXX, else g++. Ends with 0 if every fault was caught.
"""

import argparse
import concurrent.futures
import os
import pathlib
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib

here = pathlib.Path(__file__).resolve().parent
repository = here.parent.parent
sys.path.insert(0, str(repository / "scripts"))
import source_marks  # noqa: E402

compiler = os.environ.get("CXX", "g++")
nvcc = shutil.which(os.environ.get("CUDACXX", "nvcc")) or shutil.which("/usr/local/cuda/bin/nvcc")
architectures = (80, 90)

flags = ["-std=c++20", "-O1", "-w"]
if platform.machine() == "x86_64":
    flags.append("-march=x86-64-v3")  # as the suite is built

compile_limit, run_limit = 300, 120  # seconds


class DoesNotBuild(Exception):
    """What the compiler says."""


def build(*command):
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=compile_limit)
    except subprocess.TimeoutExpired:
        raise DoesNotBuild(f"takes longer than {compile_limit} s") from None
    if done.returncode != 0:
        errors = [line for line in done.stderr.splitlines() if "error" in line] or [done.stderr]
        raise DoesNotBuild(errors[0])


def failure(command, cwd):
    """How the command fails; None if it passes."""
    environment = {k: v for k, v in os.environ.items() if k != "WARPAGG_SEED"}
    try:
        done = subprocess.run(command, cwd=cwd, env=environment, timeout=run_limit,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return "hangs"
    if done.returncode < 0:
        return signal.Signals(-done.returncode).name
    return "fails" if done.returncode != 0 else None


def put_fault_in(mutation, include):
    """Puts the fault into a copy of the headers."""
    file = source_marks.find_marks(include, "mutate")[mutation["name"]]
    file.write_text(source_marks.edited(file.read_text(), "mutate", [{"at": mutation["name"], **mutation}]))


class Sweep:
    """Works on a copy of the tests and the headers, so that both may be edited meanwhile."""

    def __init__(self, scratch):
        self.scratch = scratch
        self.tests = shutil.copytree(repository / "tests", scratch / "tests")
        self.include = shutil.copytree(repository / "include", scratch / "include")
        self.main_object = scratch / "main.o"
        build(compiler, *flags, "-c", str(self.tests / "support/main.cpp"), "-o", str(self.main_object))

    def failure_of(self, test, headers, folder):
        """How a test program, named by its path in tests/ or as "HEADER on BACKEND", fails with these headers; None if it passes."""
        source = self.instantiation(test, folder) if " on " in test else self.tests / test
        if source.parent.name == "compile_fail":
            return failure(["cmake", f"-DCOMPILER={compiler}", f"-DINCLUDE={headers}", f"-DSOURCE={source}",
                            "-P", str(source.parent / "run.cmake")], folder)
        if source.parent.name == "emulate_cuda":
            self.build_emulated(source, headers, folder)
            return failure([str(folder / "program")], folder)
        definitions = []
        if test == "cuda/test_ptx.cpp":
            definitions = [self.compile_ptx(headers, folder)]
        build(compiler, *flags, *definitions, f"-I{headers}", str(source), str(self.main_object),
              "-o", str(folder / "program"))
        return failure([str(folder / "program")], folder)

    def build_emulated(self, source, headers, folder):
        """Builds a test of CUDA kernels on the emulator, as docs/how-to/test_existing_kernels.md describes it."""
        include = [f"-I{headers}", f"-I{headers}/warpagg/emulate_cuda/cuda_headers"]
        runtime = folder / "runtime.cpp"
        runtime.write_text("#include <warpagg/emulate_cuda/runtime.hpp>\n")
        build(compiler, *flags, *include, "-c", str(runtime), "-o", str(folder / "runtime.o"))
        build(compiler, *flags, "-O0", "-g", "-fsanitize=thread", "-fsanitize=bounds", *include, "-c", str(source),
              "-o", str(folder / "test.o"))
        build(compiler, str(folder / "test.o"), str(folder / "runtime.o"), str(self.main_object),
              "-Wl,--wrap=memcpy,--wrap=memmove,--wrap=memset", "-o", str(folder / "program"))

    def instantiation(self, test, folder):
        """The source file of "HEADER on BACKEND", as CMake writes it for the first such line of its list."""
        header, backend = test.split(" on ")
        lines = (self.tests / "instantiations.cmake").read_text()
        types = re.search(rf"^instantiate\({re.escape(header)} {backend} \w+ ?(.*)\)$", lines, re.MULTILINE)[1]
        values = {"tests": str(self.tests), "header": header, "backend": backend, "types": ", ".join(types.split())}
        source = folder / "instantiation.cpp"
        text = (self.tests / "support/instantiation.in").read_text()
        source.write_text(re.sub("@(.*?)@", lambda name: values[name[1]], text))
        return source

    def compile_ptx(self, headers, folder):
        files = []
        for architecture in architectures:
            files.append(f'"{folder}/{architecture}.ptx"')
            build(nvcc, "-std=c++20", "-w", "-ptx", f"-arch=sm_{architecture}", f"-I{headers}",
                  str(self.tests / "cuda/ptx/kernels.cu"), "-o", files[-1].strip('"'))
        return f"-DWARPAGG_PTX_FILES={','.join(files)}"

    def without_fault(self, test):
        """How the program fails as things are; None if it passes."""
        folder = self.scratch / "without" / test
        folder.mkdir(parents=True)
        try:
            return self.failure_of(test, self.include, folder)
        except DoesNotBuild as error:
            return f"does not compile: {error}"

    def with_fault(self, mutation):
        """(caught, what happened, seconds)"""
        start = time.monotonic()
        folder = self.scratch / "with" / mutation["name"]
        headers = folder / "include"
        shutil.copytree(self.include, headers)
        put_fault_in(mutation, headers)
        try:
            how = self.failure_of(mutation["caught_by"], headers, folder)
            caught, what = how is not None, how or "SURVIVES"
        except DoesNotBuild as error:
            caught, what = False, f"DOES NOT COMPILE: {error}"
        shutil.rmtree(folder)
        return caught, what, time.monotonic() - start

    def run(self, mutations, jobs):
        """Whether all of them are caught; says so as it goes."""
        start = time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            programs = sorted({m["caught_by"] for m in mutations})
            broken = {test: how for test, how in zip(programs, pool.map(self.without_fault, programs)) if how}
            for test, how in broken.items():
                print(f"without any fault, {test} {how}", file=sys.stderr)
            if broken:
                return False
            seconds = time.monotonic() - start
            print(f"without any fault, all {len(programs)} programs pass ({seconds:.0f} s)", flush=True)

            survivors = 0
            for m, (caught, what, seconds) in zip(mutations, pool.map(self.with_fault, mutations)):
                survivors += not caught
                print(f"{m['name']:34} {m['caught_by']:46} {seconds:4.0f} s  {what}", flush=True)
        print(f"{len(mutations) - survivors} of {len(mutations)} caught, {time.monotonic() - start:.0f} s in all")
        return survivors == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="NAME", action="append", help="this one alone; may be repeated")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="how many at a time")
    parser.add_argument("--list", action="store_true", help="name them and stop")
    arguments = parser.parse_args()

    mutations = tomllib.loads((here / "mutations.toml").read_text())["mutation"]
    names = [m["name"] for m in mutations]
    if len(set(names)) < len(names):
        sys.exit("two mutations have one name")
    try:
        files = source_marks.find_marks(repository / "include", "mutate")
        source_marks.check(files, names, "mutate")
    except source_marks.MarkError as error:
        sys.exit(str(error))
    if arguments.only:
        if unknown := set(arguments.only) - set(names):
            sys.exit(f"no mutation is named {', '.join(unknown)}")
        mutations = [m for m in mutations if m["name"] in arguments.only]
    if arguments.list:
        for m in mutations:
            print(f"{m['name']:34} {files[m['name']].name:34} {m['caught_by']}")
        return
    if nvcc is None:
        for m in mutations:
            if m["caught_by"] == "cuda/test_ptx.cpp":
                print(f"{m['name']}: skipped, there is no nvcc")
        mutations = [m for m in mutations if m["caught_by"] != "cuda/test_ptx.cpp"]
    with tempfile.TemporaryDirectory(prefix="warpagg-mutation-") as scratch:
        sys.exit(0 if Sweep(pathlib.Path(scratch)).run(mutations, arguments.jobs) else 1)


if __name__ == "__main__":
    main()
