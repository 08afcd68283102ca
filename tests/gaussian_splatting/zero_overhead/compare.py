#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""An effect that is off costs nothing: kernels are, instruction by instruction, what sources without the effect make them.

    compare.py CXX [NVCC]

What stands behind `if constexpr (Effects...` or `(Masked)` is cut out of a copy of the sources, and of the projections that
`std::conditional_t<Effects.lens...` chooses from, all but the pinhole camera's, and likewise what `Effects.motion` chooses. With
the effects off both must come to the same assembly (and, with NVCC, PTX), and with them on to another.
"""
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCES = HERE.parent.parent.parent / "examples" / "gaussian_splatting"
EFFECT_STATEMENTS = 23
STATEMENT = re.compile(r"^ *if constexpr \((?:Effects\.\w+(?: == [\w:]+)?|Masked)\)\s[^;]*;\n", re.MULTILINE)

CHOICE = re.compile(r"std::conditional_t<Effects\.(?:lens != lens_model::pinhole|motion),[^;]*, ([^,]*)>;")


def compiled(command, sources, effects):
    done = subprocess.run([*command, f"-DEFFECTS={effects}", f"-I{sources}", f"-I{HERE.parent.parent.parent / 'include'}",
                           HERE / "kernels.cpp", "-o", "-"], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    # Mangled names hold the parameters' values.
    return re.sub(r"\S*(effect_set|sum_and_difference|ssim_compare|l1_ssim_gradient|fused_l1_ssim)\S*", "", done.stdout)


def without_effects(folder):
    """A copy of the sources. Returns it, and how many statements were cut out of it."""
    copy = pathlib.Path(shutil.copytree(SOURCES, pathlib.Path(folder) / "sources"))
    cut = 0
    for header in sorted(h for folder in ("render", "losses", "metrics") for h in (copy / folder).rglob("*.hpp")):
        text, n = STATEMENT.subn("", header.read_text())
        text, m = CHOICE.subn(r"\1;", text)
        header.write_text(text)
        cut += n + m
    return copy, cut


def main():
    cxx, *nvcc = sys.argv[1:]
    level = ["-march=x86-64-v3"] if platform.machine() == "x86_64" else []
    commands = {"assembly": [cxx, "-std=c++20", "-O3", *level, "-ffp-contract=off", "-S"]}
    if nvcc:
        commands["PTX"] = [nvcc[0], "-x", "cu", "-std=c++20", "-O3", "-arch=sm_90", "-diag-suppress", "20012", "-ptx"]
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        bare, cut = without_effects(folder)
        if cut != EFFECT_STATEMENTS:
            wrong.append(f"{cut} statements of effects were found instead of {EFFECT_STATEMENTS}")
        for what, command in commands.items():
            off, on, none = compiled(command, SOURCES, "false"), compiled(command, SOURCES, "true"), compiled(command, bare, "false")
            lines = len(off.splitlines())
            print(f"{what}: {lines} lines with effects off, {len(on.splitlines())} with all on")
            if off != none:
                wrong.append(f"{what} with effects off is not that of sources without them")
            if on == off:
                wrong.append(f"{what} with effects on is that without")
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
