# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""The machine and the sources that figures belong to, and the command line of the scripts."""
import os
import re
import subprocess
import sys


def first_line(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip().splitlines()[0]
    except (OSError, subprocess.CalledProcessError, IndexError):
        return None


def environment(commit):
    nvcc = first_line("sh", "-c", "nvcc --version | grep release")
    processor = first_line("sh", "-c", "grep -m1 'model name' /proc/cpuinfo | cut -d: -f2")
    return {"commit": commit or first_line("git", "describe", "--always", "--dirty", "--abbrev=12"),
            "gpu_and_driver": first_line("nvidia-smi", "--query-gpu=name,driver_version", "--format=csv,noheader"),
            "nvcc": nvcc and nvcc.split(" V")[-1],
            "compiler": first_line("c++", "--version"),
            "processor": processor and f"{processor}, {os.cpu_count()} processors"}


def compilers_of(build):
    """The compilers of a CMake build folder. Programs may have been built on another machine."""
    found = {}
    for key, language in ("compiler", "CXX"), ("nvcc", "CUDA"):
        for file in build.glob(f"CMakeFiles/*/CMake{language}Compiler.cmake"):
            values = dict(re.findall(rf'set\(CMAKE_{language}_COMPILER_(ID|VERSION) "(.*)"\)', file.read_text()))
            found[key] = values["VERSION"] if language == "CUDA" else f"{values['ID']} {values['VERSION']}"
    return found


def own_and_passed_on():
    """The command line up to its first "--", and the lists of words that this and any further ones begin."""
    parts = [[]]
    for word in sys.argv[1:]:
        if word == "--":
            parts.append([])
        else:
            parts[-1].append(word)
    return parts[0], parts[1:]
