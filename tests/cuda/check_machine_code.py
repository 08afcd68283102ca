#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Checks registers and instructions of machine_code.cu: tests/cuda/check_machine_code.py NVCC

It compiles for compute capabilities 8.0 and 9.0. It checks instructions in SASS if cuobjdump is
installed beside nvcc, and always in PTX, from which the assembler makes RED of an atomic whose
result is not used.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MOST_REGISTERS = {"backwardILi32": 128, "backwardILi3E": 48}


def run(*command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode:
        raise SystemExit(f"{' '.join(command)}\n{result.stderr}")
    return result.stdout + result.stderr


def bodies(text, start):
    """Yields (name, body) of each function that begins at a match of `start`."""
    parts = re.split(start, text)
    return zip(parts[1::2], parts[2::2])


def check(nvcc, architecture, folder, faults):
    compile_ = [nvcc, "-std=c++20", f"-arch=sm_{architecture}", "-I", str(HERE.parents[1] / "include"), str(HERE / "machine_code.cu")]
    cubin, ptx = folder / "machine_code.cubin", folder / "machine_code.ptx"
    messages = run(*compile_, "-Xptxas", "-v", "-cubin", "-o", str(cubin))
    examined = 0
    for name, body in bodies(messages, r"Compiling entry function '(\S+)'"):
        registers = int(re.search(r"Used (\d+) registers", body)[1])
        spilled = int(re.search(r"(\d+) bytes spill stores", body)[1])
        for part, most in MOST_REGISTERS.items():
            if part in name:
                examined += 1
                print(f"sm_{architecture}: {name}: {registers} registers, {spilled} bytes spilled")
                if registers > most or spilled:
                    faults.append(f"sm_{architecture}: {name} takes {registers} registers, at most {most} expected, and spills {spilled} bytes")
    if examined != 4:
        faults.append(f"sm_{architecture}: expected 4 kernels, found {examined}")

    run(*compile_, "-ptx", "-o", str(ptx))
    kernels = dict(bodies(ptx.read_text(), r"\.entry (\w+)\("))
    for name in ("pairs_of_half", "pairs_of_half_by_key") + (("pairs_of_bfloat16",) if architecture >= 90 else ()):
        expect(kernels[name], r"\bred\.\S*f16x2", r"\batom\.", f"PTX of sm_{architecture}, {name}", faults)

    cuobjdump = shutil.which("cuobjdump", path=str(pathlib.Path(nvcc).parent)) or shutil.which("cuobjdump")
    if cuobjdump is None:
        print("skipped: SASS, because cuobjdump is not installed")
        return
    kernels = dict(bodies(run(cuobjdump, "-sass", str(cubin)), r"Function : (\w+)"))
    for name in ("pairs_of_half", "pairs_of_half_by_key") + (("pairs_of_bfloat16",) if architecture >= 90 else ()):
        expect(kernels[name], r"\bREDG?\.\S*F16", r"\bATOMG?\.", f"SASS of sm_{architecture}, {name}", faults)


def expect(code, wanted, unwanted, where, faults):
    if not re.search(wanted, code):
        faults.append(f"{where}: no instruction matches {wanted}")
    if found := re.search(unwanted + r"\S*", code):
        faults.append(f"{where}: {found[0]} returns a result that nothing uses")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    problems = []
    with tempfile.TemporaryDirectory() as work:
        for target in (80, 90):
            check(sys.argv[1], target, pathlib.Path(work), problems)
    for problem in problems:
        print(problem)
    sys.exit(bool(problems))
