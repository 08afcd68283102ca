#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Writes the tables of the documentation from bench/results.

A table stands between the lines "<!-- table NAME -->" and "<!-- end of table -->" of a file in docs/.
With --check nothing is written, and a table that differs from its figures is an error.
"""
import argparse
import itertools
import json
import pathlib
import re
import statistics
import sys

from decisions import tables as decisions_tables
from effects import table as effects_table
from environment import markdown
from lab import paper
from lab.tradeoff import table as tradeoff_table
from scenes import where

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = re.compile(r"(<!-- table (\w+) -->\n).*?(<!-- end of table -->)", re.DOTALL)
MAIN_N = (1, 2, 3, 4, 8, 9, 16, 24, 32)


def results(name):
    return json.loads((ROOT / "bench" / "results" / f"{name}.json").read_text())


class Atomics:
    """Milliseconds by type, number of values, active lanes and policy."""

    def __init__(self):
        self.figures = results("atomics")
        self.ms, spreads = {}, []
        for question in self.figures["median_least_most"]:
            for policy, (median, least, most) in question["ms"].items():
                self.ms[question["type"], question["n"], question["active"], policy] = median
                if median > 0.3:
                    spreads.append((most - least) / median)
        self.spread = f"spread (largest - least) / median up to {100 * max(spreads):.0f} %"

    def numbers(self, kind):
        return sorted({key[1] for key in self.ms if key[0] == kind})

    def cell(self, kind, n, active, policy):
        ms = self.ms.get((kind, n, active, policy))
        return "" if ms is None else f"{ms:.2f}"


def by_share(active):
    atomics = Atomics()
    policies = ["per_lane", "shfl_down", "butterfly", "scatter", "cub", "cooperative, scalar", "default"]
    policies.append("default, unaligned")
    rows = [[str(n)] + [atomics.cell("float", n, active, p) for p in policies] for n in MAIN_N]
    rows = [row for row in rows if any(row[1:])]
    return markdown(["N"] + policies, rows)


def atomics_dense():
    f = Atomics().figures
    return by_share("32") + (
        f"\n{f['gpu']}, driver {f['driver']}, nvcc {f['nvcc']}, commit {f['commit']}, seed {f['seed']}; "
        f"{f['warp_steps'] / 1e6:.1f} million warp steps; median of {f['rounds']} rounds in which the policies take turns, "
        f"{Atomics().spread}.\n"
    )


def atomics_sparse():
    return by_share("3 %")


def gates():
    atomics = Atomics()
    counts = ["1", "2", "3", "4", "6", "8", "12", "32"]
    rows = []
    for n in (2, 4, 9, 16, 32):
        for policy in ("per_lane", "per_lane, packed<4>", "scatter", "default"):
            rows.append([str(n), policy] + [atomics.cell("float", n, c, policy) for c in counts])
    return markdown(["N", "policy"] + counts, rows)


def types():
    atomics = Atomics()
    policies = ["per_lane", "shfl_down", "butterfly", "scatter", "redux", "default"]
    rows = []
    for kind in ("double", "unsigned", "int64", "half2"):
        for n in (1, 4, 9, 32):
            rows.append([kind, str(n)] + [atomics.cell(kind, n, "32", p) for p in policies])
    return markdown(["type", "N"] + policies, rows)


def default_against_best():
    """The default's time over that of the best of per_lane, shfl_down and scatter, for every N."""
    atomics = Atomics()
    rows = []
    for active, policy in itertools.product(("32", "3 %"), ("default", "default, unaligned")):
        ratios = []
        for n in atomics.numbers("float"):
            best = min(atomics.ms["float", n, active, p] for p in ("per_lane", "shfl_down", "scatter"))
            ratios.append((n, atomics.ms["float", n, active, policy] / best))
        slower = ", ".join(f"N = {n}: {r:.2f}" for n, r in ratios if r > 1.05)
        range_ = f"{min(r for _, r in ratios):.2f} to {max(r for _, r in ratios):.2f}"
        rows.append([active, "" if policy == "default" else "not aligned", range_, slower or "none"])
    return markdown(["active lanes", "records", "default / best of three, N = 1 to 32", "above 1.05"], rows)


def experiments():
    figures = results("experiments")
    rows = [[r["idea"], f"{r['ms_all']:.2f}", f"{r['ms_3_percent']:.2f}"] for r in figures["rows"]]
    return markdown(["N = 9, float", "all lanes active", "3 % of lanes active"], rows)


def match():
    figures = results("match")
    rows = [
        [r["type"], str(r["n"]), r["keys"], f"{r['ms_plain']:.2f}", f"{r['ms_matched']:.2f}", f"{r['ratio']:.2f}"]
        for r in figures["rows"]
    ]
    return markdown(["type", "N", "keys of a warp", "plain atomics, ms", "matched, ms", "ratio"], rows)


def example(machine, title):
    def table():
        found = [t for t in results(f"examples_{machine}")["tables"] if t["title"].startswith(title)]
        head = list(found[0]["rows"][0])
        return markdown(head, [list(row.values()) for row in found[0]["rows"]])

    return table


def examples_origin():
    f = results("examples_gpu")
    return (
        f"Here on an {f['gpu'].removeprefix('NVIDIA ')}, driver {f['driver']}, nvcc {f['nvcc']}, commit {f['commit']}, "
        f"seed {f['seed']}, at a size of 2^24; median of {f['rounds']} rounds in which the two take turns.\n"
    )


def stability():
    f = results("stability")

    def db(value):
        return "" if value is None else f"{value:.2f}"

    rows = [
        [
            r["what"],
            f"{r['iterations']:,}",
            f"{r['first_gaussians']:,}",
            f"{r['gaussians']:,}",
            db(r["training_psnr"]),
            db(r["held_out_psnr"]),
            db(r["ply_training_psnr"]),
            str(r["skipped_steps"]),
        ]
        for r in f["rows"]
        if r["sound"]
    ]
    head = ["what is hard", "iterations", "Gaussians at first", "at the end", "training PSNR, dB", "held-out", "training, from the `.ply`"]
    unsound = [r["name"] for r in f["rows"] if not r["sound"]]
    return markdown(head + ["skipped steps"], rows) + (
        f"\nNot finite, or not in place: {', '.join(unsound) or 'none'}. {f['device']}, driver {f['driver']}, nvcc {f['nvcc']}, "
        f"commit {f['commit']}, seed {f['seed']}, photos of {f['resolution']} pixels a side.\n"
    )


def hard_cases():
    f = results("hard_cases")
    devices = [name for name in f["rows"][0]["cells"] if " " not in name]

    def cell(row, device):
        cells = [c for name, c in row["cells"].items() if name.split()[0] == device and c != "n/a"]
        good = cells.count("ok")
        if good < len(cells):
            return f"**{len(cells) - good} of {len(cells)} fail**"
        return "ok" if good == 1 else f"ok, {good} variants"

    rows = [[row["case"]] + [cell(row, d) for d in devices] + [row["remarks"]] for row in f["rows"]]
    return markdown(["case"] + devices + ["remarks"], rows) + f"\n{machine(f)}\n"


def against_double():
    f = results("hard_cases")
    rows = [
        [r["scene"], r["column"], f"{r['error_over_bound']:.2f}", f"{1 - r['cosine']:.1e}", f"{r['bias']:.1e}"]
        for r in f["against_double"]
    ]
    head = ["scenes", "device and variant", "largest error / (1e-3 relative + 1e-5 of the largest)", "1 - least cosine"]
    return markdown(head + ["largest signed bias"], rows) + f"\n{machine(f)}\n"


BACKWARD_SCENES = {"backward_lego": "lego 400²", "backward_lego_1600": "lego 1600²", "backward_random": "random, 1600×1066"}


def backward_rows(kind):
    figures = {name: results(name) for name in BACKWARD_SCENES}
    rows = []
    for i, first in enumerate(next(iter(figures.values()))[kind]):
        row = [f"`{first['name']}`" if kind == "ladder" else first["name"]]
        for f in figures.values():
            v = f[kind][i]
            row += [f"{v['backward_ms']:.3f}", f"{v['times_as_fast']:.1f}×", f"{v['forward_ms']:.3f}"]
        rows.append(row)
    head = ["variant"] + [cell for scene in BACKWARD_SCENES.values() for cell in (f"{scene}: backward, ms", "", "forward, ms")]
    f = figures["backward_lego"]
    spread = max((v["backward_ms_most"] - v["backward_ms_least"]) / v["backward_ms"]
                 for g in figures.values() for v in g["ladder"] + g["contenders"])
    apart = max(v["apart"] for g in figures.values() for v in g["ladder"] + g["contenders"])
    note = (f"Median of {f['rounds']} rounds, spread (largest - least) / median up to {100 * spread:.0f} %; sums at most {apart:.0e} "
            f"from the first one's. {f['device']}, driver {f['driver']}, nvcc {f['nvcc']}, commit {f['commit']}, seed {f['seed']}; "
            + ", ".join(f"{scene}: {g['gaussians']:,} Gaussians, {g['views']} views"
                        for scene, g in zip(BACKWARD_SCENES.values(), figures.values())) + ".")
    return markdown(head, rows) + f"\n{note}\n"


def backward_ladder():
    return backward_rows("ladder")


def backward_contenders():
    return backward_rows("contenders")


def roofline():
    f = results("roofline")
    rows = []
    for scene in f["scenes"]:
        for kernel in ("forward", "backward"):
            k, pairs = scene[kernel], scene["pairs"]
            rows.append([scene["scene"], kernel, f"{pairs / 1e6:.0f}", f"{k['nanoseconds'] / 1e6:.3f}",
                         f"{32 * k['instructions'] / pairs:.0f}", f"{k['issue_percent']:.0f} %",
                         f"{k['l2_sectors'] / pairs:.3f}", f"{k['device_memory_bytes'] / pairs:.2f}",
                         f"{k['device_memory_bytes'] / k['nanoseconds']:.0f}"])
    head = ["scene", "blending", "million pairs forward", "ms", "instructions a pair", "issue slots used", "L2 sectors a pair",
            "bytes of memory a pair", "GB/s"]
    return markdown(head, rows) + f"\n{machine(f)}\n"


def schedules():
    """Each switch of the training schedule: PSNR, seconds in the loop and Gaussians, and how they stand to the default's."""
    f = results("schedules")
    scenes = list(f["to_default"])
    rows = []
    for name in dict.fromkeys(r["options"] for r in f["runs"]):
        row = [name]
        for scene in scenes:
            same = [r for r in f["runs"] if r["scene"] == scene and r["options"] == name]
            to = f["to_default"][scene].get(name)
            middle = lambda pick: statistics.median(pick(r) for r in same)
            psnr, loop, gaussians = middle(lambda r: r["psnr"]), middle(lambda r: r["seconds"]["train"]), middle(lambda r: r["gaussians"])
            row += [f"{psnr:.2f}" + (f" ({to['dB']:+.2f})" if to else ""),
                    f"{loop:.1f}" + (f" ({to['loop']:.2f}×)" if to else ""),
                    f"{gaussians:,.0f}" + (f" ({to['Gaussians']:.2f}×)" if to else "")]
        rows.append(row)
    head = ["options"] + [cell for s in scenes for cell in (f"{s}: held-out PSNR, dB", "loop, s", "Gaussians")]
    options = " ".join(["-i", str(f["runs"][0]["iterations"]), *f["options"]])
    machine_and_seeds = where(f).split(";")[0]
    return markdown(head, rows) + f"\n`{options}`, {machine_and_seeds}; medians, in brackets how they stand to the default's.\n"


def tradeoff():
    return tradeoff_table(results("tradeoff_lego"))


def tradeoff_default():
    return tradeoff_table(results("tradeoff_lego_default"))


def decisions():
    return decisions_tables(results("decisions"))


def effects():
    return effects_table(results("effects"))


def effects_photos():
    """Held-out PSNR of photos without and with what they call for."""
    none, auto = (results(f"effects_cpu_{selection}") for selection in ("none", "auto"))
    rows = [[a["scene"], f"{n['psnr']:.2f}", f"{a['psnr']:.2f} ({a['psnr'] - n['psnr']:+.2f})"]
            for n, a in zip(none["runs"], auto["runs"], strict=True)]
    head = ["scene", "`--effects none`: held-out PSNR, dB", "`auto`"]
    return f"{markdown(head, rows)}\n`{' '.join(auto['options'])}`, {where(auto)}\n"


def accuracy_of(name):
    """Each way of keeping a sum: errors by condition, of its bound, bit patterns, and cost beside native's."""
    f = results(name)
    of = lambda row: {t["tag"]: t for t in row["tags"]}
    one = {row["values"]: of(row) for row in f["rows"] if row["sums"] == 1}
    conditions = {"condition 1e00": "k = 1", "condition 1e06": "1e6", "condition 1e12": "1e12"}
    cost = lambda tags, tag: tags[tag]["nanoseconds_a_value"]["median"]
    rows, spread = [], 0
    for tag in next(iter(one.values())):
        same = [of(row)[tag] for row in f["rows"]]
        spread = max([spread] + [(t["nanoseconds_a_value"]["most"] - t["nanoseconds_a_value"]["least"]) / t["nanoseconds_a_value"]["median"]
                                 for t in same])
        times = [statistics.median(cost(of(row), tag) / cost(of(row), "native") for row in f["rows"] if row["sums"] == sums)
                 for sums in sorted({row["sums"] for row in f["rows"]})]
        patterns = [t["bit_patterns"] for t in same]
        rows.append([f"`{tag}`"] + [f"{one[c][tag]['largest_error']:.0e}" for c in conditions]
                    + [f"{max(t['error_over_bound'] for t in same):.2g}",
                       f"{min(patterns)} to {max(patterns)}" if min(patterns) < max(patterns) else f"{max(patterns)}"]
                    + [f"{t:.3g}×" for t in times])
    head = ["tag"] + [f"largest relative error, {c}" for c in conditions.values()] + ["of its bound, at most", "bit patterns"]
    head += [f"time, {sums:,} sum{'s' * (sums > 1)}" for sums in sorted({row["sums"] for row in f["rows"]})]
    return markdown(head, rows) + (f"\n{f['rows'][0]['n']:,.0f} values in {f['orders']} orders; median of times, beside `native`'s; spread (largest - least) / "
                                   f"median up to {100 * spread:.0f} %. {accuracy_machine(f)}\n")


def accuracy_machine(f):
    where = f"{f['device']}, driver {f['driver']}, nvcc {f['nvcc']}" if f["device"].startswith("cuda") else f"{f['device']}, {f['processor']}, {f['compiler']}"
    return f"{where}, commit {f['commit']}, seed {f['seed']}."


def accuracy():
    return accuracy_of("accuracy_emulator")


def accuracy_gpu():
    return accuracy_of("accuracy_gpu")


def accuracy_active():
    """Nanoseconds a value against the share of the lanes that have one."""
    f = results("accuracy_gpu_active")
    columns = [(row["sums"], row["active"]) for row in f["rows"]]
    of = {column: {t["tag"]: t["nanoseconds_a_value"]["median"] for t in row["tags"]} for column, row in zip(columns, f["rows"])}
    rows = [[f"`{tag}`"] + [f"{of[c][tag]:.3g}" for c in columns] for tag in of[columns[0]]]
    head = ["ns a value"] + [f"{sums:,} sum{'s' * (sums > 1)}, {100 * share:.0f} % of the lanes" for sums, share in columns]
    return markdown(head, rows) + f"\n{f['rows'][0]['n']:,.0f} values, median of {f['orders']} orders. {accuracy_machine(f)}\n"


def accumulations():
    """In what the trainer's gradients are added up: time of the kernel and of training, and what it changes."""
    kernels = [results("accumulate_backward_lego"), results("accumulate_backward_lego_1600")]
    training = results("accumulate_lego")
    median = lambda mode, pick: statistics.median(pick(r) for r in training["modes"][mode])
    rows = []
    for i, mode in enumerate(training["modes"]):
        row = [f"`{mode}`"]
        for k in kernels:
            standing, first = k["accumulations"][i], k["accumulations"][0]
            row += [f"{standing['backward_ms']:.3f} ({standing['backward_ms'] / first['backward_ms']:.2f}×)"]
        row += [f"{kernels[0]['accumulations'][i]['error']:.1e}", f"{kernels[0]['accumulations'][i]['apart']:.1e}"]
        loop = lambda r: r["seconds"]["train"]
        psnr = sorted(r["psnr"] for r in training["modes"][mode])
        row += [f"{median(mode, loop):.2f} ({median(mode, loop) / median('native', loop):.2f}×)",
                f"{statistics.mean(psnr):.3f} ({psnr[0]:.2f} to {psnr[-1]:.2f})"]
        rows.append(row)
    head = ["`--accumulate`", "backward blending, ms, lego 400²", "1600²", "sums' distance from double, 400²", "from `native`'s",
            "training, s", "held-out PSNR, dB, mean of three seeds"]
    k = kernels[0]
    return markdown(head, rows) + (f"\nKernel: {k['gaussians']:,} Gaussians, median of {k['rounds']} rounds, {k['device']}, driver {k['driver']}, nvcc {k['nvcc']}, commit {k['commit']}, "
                                   f"seed {k['seed']}. Training: lego 400², 7,000 iterations, seeds 0, 1, 2, {machine(training)}\n")


def machine(figures):
    return f"{figures['gpu_and_driver']}, {figures['nvcc']}, commit {figures['commit']}."


EXAMPLES = {
    "histogram": "Histogram",
    "embedding_gradient": "Gradient of an embedding",
    "charge_deposit": "Charge deposit",
    "kmeans_update": "k-means update",
    "transposed_spmv": "Sparse matrix-transpose product",
    "torch": "PyTorch",
}

TABLES = {f.__name__: f for f in (atomics_dense, atomics_sparse, gates, types, default_against_best, experiments, match, examples_origin, stability, hard_cases,
                                 against_double, backward_ladder, backward_contenders, roofline, schedules, tradeoff, tradeoff_default, decisions, effects, effects_photos, accuracy, accuracy_gpu,
                                 accuracy_active, accumulations)}
TABLES.update({name: lambda name=name: paper.tables(results(name)) for name in ("paper_cpu", "paper_h200", "paper_h200_20s")})
TABLES.update({f"{name}_{m}": example(m, title) for name, title in EXAMPLES.items() for m in ("emulator", "gpu")})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true")
    check = parser.parse_args().check
    stale = []
    for page in sorted((ROOT / "docs").glob("*.md")):
        text = page.read_text()
        new = TABLE.sub(lambda m: m.group(1) + TABLES[m.group(2)]() + m.group(3), text)
        if new != text:
            stale.append(page.relative_to(ROOT))
            if not check:
                page.write_text(new)
    for page in stale:
        print(f"{page}: {'is not what bench/results says; run bench/tables.py' if check else 'written'}")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
