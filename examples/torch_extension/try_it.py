# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""warpagg in a PyTorch extension: index_add_ beside PyTorch's own. Needs PyTorch with CUDA, nvcc and ninja.

    python examples/torch_extension/try_it.py
"""
import statistics
from pathlib import Path

import torch
from torch.utils.cpp_extension import load

here = Path(__file__).resolve().parent
extension = load(
    name="warpagg_index_add",
    sources=[str(here / "index_add.cpp"), str(here / "index_add_kernel.cu")],
    extra_include_paths=[str(here.parents[1] / "include")],
    extra_cflags=["-std=c++20", "-O3"],
    extra_cuda_cflags=["-std=c++20", "-O3"],
)


def milliseconds(add):
    start, end = torch.cuda.Event(enable_timing=True), torch.cuda.Event(enable_timing=True)
    start.record()
    add()
    end.record()
    end.synchronize()
    return start.elapsed_time(end)


def compare(name, index, m, d):
    """Adds rows [n, d] of small integers, whose sums are exact in float, to a table [m, d]."""
    rows = torch.randint(-2, 3, (index.numel(), d), device="cuda").float()
    expected = torch.zeros(m, d, dtype=torch.float64, device="cuda")
    expected.index_add_(0, index, rows.double())
    adds = {
        "torch": lambda table: table.index_add_(0, index, rows),
        "warpagg": lambda table: extension.index_add_(table, index, rows),
    }
    for which, add in adds.items():
        table = torch.zeros(m, d, device="cuda")
        add(table)
        if not torch.equal(table.double(), expected):
            raise SystemExit(f"{name}: {which} is wrong")
    times = {which: [] for which in adds}
    for turn in range(12):  # the two take turns; the first rounds warm up
        for which, add in adds.items():
            ms = milliseconds(lambda: add(table))
            if turn >= 3:
                times[which].append(ms)
    torch_ms, warpagg_ms = (statistics.median(t) for t in times.values())
    print(f"| {name} | {torch_ms:.3f} | {warpagg_ms:.3f} | {torch_ms / warpagg_ms:.2f}x |")


def zipf(n, m):
    """Indices in proportion to 1 / (i + 1), as words of a language by rank."""
    weights = 1.0 / torch.arange(1, m + 1, dtype=torch.float64, device="cuda")
    below = torch.cumsum(weights, 0)
    at = torch.rand(n, dtype=torch.float64, device="cuda") * below[-1]
    return torch.searchsorted(below, at).clamp_(max=m - 1)


torch.manual_seed(12345)
torch.use_deterministic_algorithms(False)
print(f"PyTorch {torch.__version__}, {torch.cuda.get_device_name()}\n")
print("| index_add_ | torch, ms | warpagg, ms | faster |\n| --- | --- | --- | --- |")
few = torch.randint(0, 16, (1 << 22,), device="cuda")
compare("4 floats into 16 rows, at random", few, 16, 4)
compare("4 floats into 16 rows, sorted", few.sort().values, 16, 4)
compare("4 floats into 2^20 rows, at random", torch.randint(0, 1 << 20, (1 << 22,), device="cuda"), 1 << 20, 4)
compare("64 floats into 32768 rows, Zipf", zipf(1 << 18, 32768), 32768, 64)
