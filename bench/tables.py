#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Prints what a benchmark program wrote as Markdown tables.

    bench/tables.py atomics FILE           # of bench_atomics
    bench/tables.py match FILE             # of bench_match
    bench/tables.py kernels FILE           # of bench_kernels
    bench/tables.py accuracy FILE          # of bench_accuracy
    bench/tables.py backward FILE...       # of lab backward, one file per scene
    bench/tables.py accumulators FILE...   # of lab backward --accumulate, one file per scene
"""
import json
import pathlib
import statistics
import sys

from markdown_tables import markdown


def print_table(title, columns, rows):
    print(f"{title}:\n\n{markdown(columns, rows)}")


def atomics(result):
    ms, spreads = {}, []
    for question in result["median_least_most"]:
        for policy, (median, least, most) in question["ms"].items():
            ms[question["type"], question["n"], question["active"], policy] = median
            if median > 0.3:
                spreads.append((most - least) / median)

    def cells(policies, *question):
        return [f"{ms[(*question, p)]:.2f}" if (*question, p) in ms else "" for p in policies]

    policies = ["per_lane", "shfl_down", "butterfly", "scatter", "cub", "default", "default, unaligned"]
    numbers = sorted({n for kind, n, *_ in ms if kind == "float"})
    million = result["warp_steps"] / 1e6
    for share, title in (("32", "all lanes active"), ("3 %", "3 % of the lanes active")):
        print_table(f"Milliseconds for {million:.1f} million warp steps that add N floats each, {title}; "
                    f"median of {result['rounds']} rounds, spread up to {100 * max(spreads):.0f} %",
                    ["N", *policies], [[str(n), *cells(policies, "float", n, share)] for n in numbers])
    counts = ["1", "2", "3", "4", "6", "8", "12", "32"]
    rows = [[str(n), policy, *(cells([policy], "float", n, c)[0] for c in counts)]
            for n in (2, 9, 32) for policy in ("per_lane", "scatter", "default")]
    print_table("Milliseconds by the number of active lanes", ["N floats", "policy", *counts], rows)
    policies = ["per_lane", "shfl_down", "butterfly", "scatter", "redux", "default"]
    rows = [[kind, str(n), *cells(policies, kind, n, "32")]
            for kind in ("double", "unsigned", "int64", "half2") for n in (1, 4, 9, 32)]
    print_table("Milliseconds for other types, all lanes active", ["type", "N", *policies], rows)


def match(result):
    rows = [[r["type"], str(r["n"]), r["keys"], f"{r['ms_plain']:.2f}", f"{r['ms_matched']:.2f}", f"{r['ratio']:.2f}"]
            for r in result["rows"]]
    print_table(f"Keys that differ within a warp: milliseconds, median of {result['rounds']} rounds",
                ["type", "N", "keys of a warp", "plain atomics", "warp_match_reduce_atomic", "times as fast"], rows)
    slower = {}
    for r in result["rows"]:
        keys = slower.setdefault((r["type"], str(r["n"])), [])
        if r["ratio_most"] < 1:
            keys.append(f"{r['keys']} ({r['ratio']:.2f})")
    print_table("Keys for which plain atomics are faster in every round, with the ratio of the times",
                ["type", "N", "keys of a warp"], [[*case, "; ".join(keys) or "none"] for case, keys in slower.items()])


RATIOS = {  # columns of tables of kernels: two variants
    "deterministic / plain atomics": ("deterministic", "plain atomics"),
    "deterministic in blocks / deterministic": ("deterministic in blocks", "deterministic"),
    "sort and reduce by key / deterministic": ("sort and reduce by key", "deterministic"),
}


def kernels(result):
    """A table for each kernel, with a column for each way to add, and for ratios of their times."""
    by_kernel, spreads = {}, []
    for row in result["rows"]:
        by_kernel.setdefault(row["kernel"], []).append(row)
        spreads += [(most - least) / median for median, least, most in row["median_least_most"].values()]
    about = f"milliseconds, median of {result['rounds']} rounds"
    print(f"The spread between rounds is {100 * statistics.median(spreads):.1f} % in the median and at most {100 * max(spreads):.0f} %.\n")
    for kernel, rows in by_kernel.items():
        variants = list(rows[0]["median_least_most"])
        ratios = {name: pair for name, pair in RATIOS.items() if set(pair) <= set(variants)}
        rasterizer = "blending" in kernel
        cells = []
        for row in rows:
            ms = {v: row["median_least_most"][v][0] for v in variants}
            cells.append([row["input"], *([f"{100 * row['idle_share']:.0f} %"] if rasterizer else []),
                          *(f"{ms[v]:.3f}" for v in variants), *(f"{ms[a] / ms[b]:.2f}" for a, b in ratios.values())])
        columns = ["input", *(["idle warp steps"] if rasterizer else []), *variants, *ratios]
        print_table(f"{kernel[0].upper()}{kernel[1:]}: {about}", columns, cells)


def accuracy(result):
    def by_tag(row):
        return {t["tag"]: t for t in row["tags"]}

    numbers_of_sums = sorted({row["sums"] for row in result["rows"]})
    one_sum = {row["values"]: by_tag(row) for row in result["rows"] if row["sums"] == 1}
    conditions = {"condition 1e00": "1", "condition 1e06": "1e6", "condition 1e12": "1e12"}
    rows = []
    for tag in next(iter(one_sum.values())):
        same = [by_tag(row)[tag] for row in result["rows"]]
        ratios = [statistics.median(by_tag(row)[tag]["nanoseconds_a_value"]["median"] /
                                    by_tag(row)["native"]["nanoseconds_a_value"]["median"]
                                    for row in result["rows"] if row["sums"] == sums) for sums in numbers_of_sums]
        patterns = max(t["bit_patterns"] for t in same)
        rows.append([f"`{tag}`", *(f"{one_sum[c][tag]['largest_error']:.0e}" for c in conditions),
                     f"{max(t['error_over_bound'] for t in same):.2g}", str(patterns), *(f"{r:.3g}" for r in ratios)])
    size = result["rows"][0]["n"]
    print_table(f"Sums of {size:,.0f} floats in {result['orders']} orders: errors, and time relative to `native`",
                ["accumulator", *(f"largest relative error, condition {c}" for c in conditions.values()),
                 "largest share of its bound", "different results", *(f"time, {s:,} sums" if s > 1 else "time, one sum" for s in numbers_of_sums)],
                rows)


def scene_of(result):
    return f"{result['scene']}, {result['width']}×{result['height']}"


def backward(*results):
    rows = []
    for i, first in enumerate(results[0]["ladder"]):
        row = [f"`{first['name']}`"]
        for result in results:
            v = result["ladder"][i]
            row += [f"{v['backward_ms']:.3f}", f"{v['times_as_fast']:.1f}", f"{v['forward_ms']:.3f}"]
        rows.append(row)
    spread = max((v["backward_ms_most"] - v["backward_ms_least"]) / v["backward_ms"] for r in results for v in r["ladder"])
    columns = ["step", *(f"{scene_of(r)}: {what}" for r in results for what in ("backward, ms", "times as fast", "forward, ms"))]
    about = "; ".join(f"{r['scene']}: {r['gaussians']:,} Gaussians" for r in results)
    print_table(f"Blending per view; median of {results[0]['rounds']} rounds, spread up to {100 * spread:.0f} %; {about}", columns, rows)


def accumulators(*results):
    rows = []
    for i, first in enumerate(results[0]["accumulations"]):
        row = [f"`{first['name']}`" if i else "`native`"]
        for result in results:
            v, native = result["accumulations"][i], result["accumulations"][0]
            row += [f"{v['backward_ms']:.3f}", f"{v['backward_ms'] / native['backward_ms']:.2f}", f"{v['error']:.1e}", f"{v['apart']:.1e}"]
        rows.append(row)
    columns = ["accumulator", *(f"{scene_of(r)}: {what}" for r in results
                                for what in ("backward, ms", "relative to native", "distance from double", "distance from native"))]
    print_table(f"Backward pass by accumulator; median of {results[0]['rounds']} rounds", columns, rows)


KINDS = {f.__name__: f for f in (atomics, match, kernels, accuracy, backward, accumulators)}

if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in KINDS:
        raise SystemExit(__doc__)
    KINDS[sys.argv[1]](*(json.loads(pathlib.Path(file).read_text()) for file in sys.argv[2:]))
