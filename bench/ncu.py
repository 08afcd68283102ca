# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""What Nsight Compute counts of kernels."""
import csv
import shutil
import subprocess


def is_there():
    return shutil.which("ncu") is not None


def profile(command, kernels, launches, metrics):
    """Of the first launches of kernels whose demangled names match: the name, and each metric by its key."""
    ncu = ["ncu", "--clock-control", "none", "--kernel-name-base", "demangled", "-k", f"regex:{kernels}",
           "--launch-count", str(launches), "--metrics", ",".join(metrics.values()), "--csv", "--page", "raw"]
    output = subprocess.run([*ncu, *map(str, command)], capture_output=True, text=True).stdout
    lines = [line for line in output.splitlines() if line.startswith('"')]
    rows = list(csv.DictReader(lines))[1:]  # the first says the units
    if not rows:
        raise SystemExit(f"ncu printed no kernels:\n{output[-2000:]}")
    return [{"kernel": row["Kernel Name"], **{key: float(row[metric].replace(",", "")) for key, metric in metrics.items()}}
            for row in rows]
