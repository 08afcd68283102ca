#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""The paper's Table 3 and Figures 2, 4, 5, 6 and 9 to 11 for any scene: trains it by each rung from the original to the default,
and measures the gradient kernel on what came of it.

    bench/lab/paper.py run --build build/bench --data ../shared/data --scenes lego truck --seconds 60 \\
        --output bench/results/paper_gpu.json -- --device cuda
    bench/lab/paper.py table bench/results/paper_gpu.json
    bench/lab/paper.py plot bench/results/paper_gpu.json docs/images/paper_gpu.svg      # needs matplotlib

The options after -- are those of every training; --images, --resolution and --device are those of `lab paper`, too. They name
no iterations: all rungs train for --iterations, and some for as many as fill --seconds in the loop, within 5 %. Seconds
in the loop are without loading and testing. Each scene is written when it is measured; those that the output holds
already, of the same commit and options, are not measured again. Figures 4, 10 and 11 are what ncu counts, where it is.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))  # bench
from environment import environment, own_and_passed_on  # noqa: E402
from markdown_tables import markdown  # noqa: E402
import ncu  # noqa: E402
from scenes import by, train, train_into  # noqa: E402

RUNGS = ["per-lane", "reduce", "reduce-skip", "split"]
TIMED = ["per-lane", "reduce-skip", "split"]  # the paper's baseline, its own method, and our default
WITHIN = 0.05
MOST_ATTEMPTS = 8

# Warps of a scheduler that wait for a reason, on average over the cycles in which it issues; the last one is what issues.
STALLS = {reason: f"smsp__average_warps_issue_stalled_{reason}_per_issue_active.ratio" for reason in
          ("lg_throttle", "long_scoreboard", "short_scoreboard", "mio_throttle", "math_pipe_throttle", "wait", "not_selected",
           "barrier", "branch_resolving", "dispatch_stall", "drain", "imc_miss", "membar", "misc", "no_instruction", "sleeping",
           "tex_throttle", "selected")}
USE = {"lsu_percent": "sm__inst_executed_pipe_lsu.avg.pct_of_peak_sustained_active",
       "issue_percent": "smsp__issue_active.avg.pct_of_peak_sustained_active"}

# What the paper says in words and in Table 3: its figures have no numbers. Mean and most of its six scenes.
PAPER_MEAN = {"RTX 4090": {"share": "47.0 % (59.2 %)", "gradient": "3.04× (5.2×)", "loop": "1.58× (2.05×)"},
              "RTX 3060": {"gradient": "2.04× (2.92×)", "loop": "1.37× (1.61×)"},
              "GPU not said": {"plain": "17.16× (34.21×)"}}
PAPER_GPUS = ["RTX 4090", "RTX 3060"]  # of Table 3
PAPER_PSNR = {"lego": (35.793, 35.682, 33.708, 34.264), "drums": (29.990, 30.124, 28.856, 29.034),
              "playroom": (32.843, 34.975, 29.988, 30.195), "drjohnson": (29.549, 32.160, 28.025, 29.076),
              "truck": (24.779, 25.851, 23.723, 24.170), "train": (23.591, 23.638, 19.393, 21.371)}


def filling(seconds, first, run_of):
    """The run of nearest to so many seconds in the loop, found from one of other length; run_of(iterations) makes it.
    Seconds grow by some power of the iterations, since Gaussians grow in number: the last two runs tell which."""
    runs, power = [first], 1
    while len(runs) <= MOST_ATTEMPTS and (len(runs) == 1 or off(runs[-1], seconds) > WITHIN):
        run = runs[-1]
        runs.append(run_of(max(1, round(run["iterations"] * (seconds / run["seconds"]["train"]) ** (1 / power)))))
        (n, m), (t, u) = [(r["iterations"] for r in runs[-2:]), (r["seconds"]["train"] for r in runs[-2:])]
        if abs(math.log(m / n)) > 0.1:  # otherwise noise decides
            power = min(max(math.log(u / t) / math.log(m / n), 0.8), 1.6)
    return {**min(runs[1:], key=lambda r: off(r, seconds)), "attempts": len(runs) - 1}


def off(run, seconds):
    return abs(run["seconds"]["train"] / seconds - 1)


def measure(arguments, scene, bench_options):
    build = pathlib.Path(arguments.build)
    program = str(build / "bench" / "lab" / "lab")

    def options(rung, iterations):
        return arguments.data, scene, arguments.seed, [*arguments.options, "--gradient", rung, "-i", str(iterations), "--overwrite"]

    def told(run, what):
        print(scene, run["gradient"], what, f"{run['iterations']} iterations, {run['seconds']['train']:.2f} s, {run['psnr']:.2f} dB", flush=True)
        return run

    same_length = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(arguments.turns):
            for rung in RUNGS:
                same_length.append(told(train_into(folder, program, *options(rung, arguments.iterations)), "of one length:"))
        ply = pathlib.Path(folder) / "point_cloud" / f"iteration_{arguments.iterations}" / "point_cloud.ply"
        figures = pathlib.Path(folder) / "paper.json"
        subprocess.run([program, "paper", str(ply), "-d", str(pathlib.Path(arguments.data) / scene),
                        "--seed", str(arguments.seed), "-o", str(figures), *bench_options], check=True)
        kernel = json.loads(figures.read_text())
        if kernel["device"].startswith("cuda") and ncu.is_there():
            command = [program, "paper", ply, "-d", pathlib.Path(arguments.data) / scene, "--views", "1",
                       "--rounds", "1", "-o", pathlib.Path(folder) / "counted.json", *bench_options]
            names = list(kernel["kernels"])  # as `lab paper` runs them first, one after the other
            counted = ncu.profile(command, "blend_backward", len(names), {**STALLS, **USE})
            kernel["counted"] = dict(zip(names, counted, strict=True))
    last = by("gradient", same_length)
    same_time = [filling(arguments.seconds, last[rung][-1], lambda n: told(train(program, *options(rung, n)), "of one time:"))
                 for rung in TIMED]
    return {"scene": scene, "same_length": same_length, "same_time": same_time, "kernel": kernel}


def run(arguments):
    shared = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for names in (["--images"], ["-r", "--resolution"], ["--device"]):
        shared.add_argument(*names)
    given = vars(shared.parse_known_args(arguments.options)[0])
    bench_options = [word for name, value in given.items() if value for word in (f"--{name}", value)]
    output = pathlib.Path(arguments.output)
    about = {"bench": "paper", "options": arguments.options, "iterations": arguments.iterations, "turns": arguments.turns,
             "seconds": arguments.seconds, "seed": arguments.seed, **environment(arguments.commit)}
    before = json.loads(output.read_text()) if output.exists() else {}
    # Files written here make a checkout dirty.
    clean = lambda told: {**told, "scenes": None, "commit": (told.get("commit") or "").removesuffix("-dirty")}
    known = before.get("scenes", []) if clean(before) == clean(about) else []
    about["commit"] = before["commit"] if known else about["commit"]
    result = {**about, "scenes": known}
    for scene in arguments.scenes:
        if scene in (s["scene"] for s in result["scenes"]):
            continue
        result["scenes"].append(measure(arguments, scene, bench_options))
        output.write_text(json.dumps(result, indent=1) + "\n")
    print(tables(result))
    if largest_off(result) > WITHIN:
        raise SystemExit(f"times that were to be equal are {100 * largest_off(result):.0f} % off: was the machine busy?")


def largest_off(result):
    return max(off(r, result["seconds"]) for s in result["scenes"] for r in s["same_time"])


def share_of_backward(scene, rung):
    def share(run):
        stages = {name: stage["milliseconds"] for name, stage in run["stages"].items()}
        return stages["blend_backward"] / sum(stages.values())
    return statistics.median(share(r) for r in by("gradient", scene["same_length"])[rung])


def to_original(scene, rung):
    """How many times as fast as per-lane: the gradient kernel, and the loop of equal iterations."""
    loop = {name: statistics.median(r["seconds"]["train"] for r in runs) for name, runs in by("gradient", scene["same_length"]).items()}
    return scene["kernel"]["kernels"][rung]["times_as_fast"], loop["per-lane"] / loop[rung]


def active(scene):
    """Of warps of 32 lanes: the shares of those that add, by lanes from 1; lanes on average; idle among those that came
    to the adding, and among all that the tiles' lists have."""
    counts = scene["kernel"]["active_lanes"]
    warps, listed = counts["warps"], counts["listed"]
    busy = sum(warps[1:])
    return ([n / busy for n in warps[1:]], sum(n * lanes for lanes, n in enumerate(warps)) / busy,
            warps[0] / (busy + warps[0]), 1 - busy / listed)


def tables(result):
    scenes, rungs = result["scenes"], RUNGS[1:]
    rows = []
    for scene in scenes:
        ratios = [to_original(scene, rung) for rung in rungs]
        rows.append([scene["scene"], *(f"{100 * share_of_backward(scene, rung):.1f} %" for rung in ("per-lane", "split")),
                     f"{scene['kernel']['kernels']['plain adds']['times_as_fast']:.2f}×",
                     *(f"{kernel:.2f}×" for kernel, _ in ratios), *(f"{loop:.2f}×" for _, loop in ratios)])
    for gpu, mean in PAPER_MEAN.items():
        columns = ["share", "", "plain", "", "gradient", "", "", "loop", ""]
        rows.append([f"the paper, {gpu}: mean (most)", *(mean.get(column, "") for column in columns)])
    head = ["scene", "backward's share of an iteration, `per-lane` (Fig. 2)", "`split`", "plain adds (Fig. 5)"]
    head += [f"{what}, `{rung}`" + (" (Fig. 9)" if rung == "reduce-skip" else "") for what in ("kernel", "loop") for rung in rungs]
    text = [markdown(head, rows)]

    rows = []
    for scene in scenes:
        shares, mean, idle, idle_of_listed = active(scene)
        eighths = [sum(shares[first:first + 4]) for first in range(0, 32, 4)]
        rows.append([scene["scene"], f"{mean:.1f}", *(f"{100 * s:.1f} %" for s in eighths), f"{100 * shares[31]:.1f} %",
                     f"{100 * idle:.1f} %", f"{100 * idle_of_listed:.1f} %"])
    head = ["scene", "active lanes, mean (Fig. 6)", *(f"{n} to {n + 3}" for n in range(1, 33, 4)), "all 32",
            "idle, of staged", "idle, of listed"]
    text.append(markdown(head, rows))

    rows = []
    for scene in scenes:
        runs = {r["gradient"]: r for r in scene["same_time"]}
        cells = [f"{runs[rung]['psnr']:.2f} ({runs[rung]['iterations']:,} in {runs[rung]['seconds']['train']:.2f} s)" for rung in TIMED]
        rows.append([scene["scene"], *cells, *(f"{psnr:.3f}" for psnr in PAPER_PSNR.get(scene["scene"], ()))])
    head = ["scene", *(f"`{rung}`: PSNR, dB (iterations)" for rung in TIMED)]
    head += [f"the paper, {gpu}, 300 s: {what}" for gpu in PAPER_GPUS for what in ("baseline", "ours")]
    text.append(markdown(head, [row + [""] * (len(head) - len(row)) for row in rows]))

    rows = []
    for scene in scenes:
        for name, counts in scene["kernel"].get("counted", {}).items():
            waiting = sum(counts[reason] for reason in STALLS)
            share = lambda *reasons: f"{100 * sum(counts[r] for r in reasons) / waiting:.0f} %"
            rest = set(STALLS) - {"lg_throttle", "long_scoreboard", "not_selected", "selected"}
            rows.append([scene["scene"], f"`{name}`" if name in RUNGS else name, f"{waiting:.1f}", share("lg_throttle"),
                         share("long_scoreboard"), share(*rest), share("not_selected"), share("selected"),
                         f"{counts['lsu_percent']:.0f} %", f"{counts['issue_percent']:.0f} %"])
    if rows:
        text.append(markdown(["scene", "kernel", "warps a scheduler has when it issues", "of them wait for room in the load-store queue (Figs. 4, 10)",
                              "for memory", "for something else", "for their turn", "issue", "load-store unit used (Fig. 11)", "issue slots used"], rows))

    first = scenes[0]["kernel"]
    machine = (f"{result['processor'].strip()}, {first['device']}, {result['compiler']}" if first["device"].startswith("cpu")
               else f"{result['gpu_and_driver']}, {result['nvcc']}")
    spread = max((k["ms_most"] - k["ms_least"]) / k["ms"] for s in scenes for k in s["kernel"]["kernels"].values())
    about = "; ".join(f"{s['scene']}: {s['kernel']['width']}×{s['kernel']['height']}, {s['kernel']['gaussians']:,} Gaussians, "
                      f"{s['kernel']['views']} views" for s in scenes)
    text.append(f"Kernel and loop: times as fast as `per-lane`. Equal length: {scenes[0]['same_length'][0]['iterations']:,} iterations, "
                f"median of {len(scenes[0]['same_length']) // len(RUNGS)}; equal "
                f"time: {result['seconds']:g} s in the loop, within {100 * largest_off(result):.1f} %. Kernels on warps of {first['lanes']} "
                f"lanes, active lanes of warps of 32; kernels: median of {first['rounds']} rounds, spread (largest - least) / median up to {100 * spread:.0f} %. {about}. "
                f"Options `{' '.join(result['options'])}`, {machine}, commit {result['commit']}, seed {result['seed']}.\n")
    return "\n".join(text)


def plot(arguments):
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams.update({"svg.hashsalt": "warpagg", "svg.fonttype": "none"})  # the same file from the same figures
    from matplotlib import pyplot
    scenes = json.loads(pathlib.Path(arguments.file).read_text())["scenes"]
    names = [s["scene"] for s in scenes]
    figure, ((share, plain), (lanes, ratio)) = pyplot.subplots(2, 2, figsize=(11, 8))

    def bars(axis, groups, title):
        styles = [("white", ""), ("white", "///"), ("0.7", ""), ("0.3", ""), ("white", "---"), ("0.7", "xx")]
        width = 0.8 / len(groups)
        for i, ((label, values), (face, hatch)) in enumerate(zip(groups.items(), styles)):
            at = [k + (i - (len(groups) - 1) / 2) * width for k in range(len(names))]
            drawn = axis.bar(at, values, width, color=face, edgecolor="black", hatch=hatch, label=label)
            axis.bar_label(drawn, fmt="%.2g", fontsize=7)
        axis.set_xticks(range(len(names)), names)
        axis.set_title(title, fontsize=9)
        axis.legend(fontsize=7, ncols=2)
        axis.margins(y=0.3)

    bars(share, {rung: [100 * share_of_backward(s, rung) for s in scenes] for rung in RUNGS},
         "backward blending, % of an iteration (Figure 2)")
    bars(plain, {"plain adds": [s["kernel"]["kernels"]["plain adds"]["times_as_fast"] for s in scenes]},
         "gradient kernel without atomics, times as fast (Figure 5)")
    for scene, style in zip(scenes, ["-", "--", ":", "-."] * len(scenes)):
        lanes.step(range(1, 33), [100 * s for s in active(scene)[0]], "k", where="mid", linestyle=style, linewidth=1, label=scene["scene"])
    lanes.set(xlabel="active lanes", yscale="log", ylabel="% of warps that add")
    lanes.set_title("active lanes when a warp adds (Figure 6)", fontsize=9)
    lanes.legend(fontsize=7)
    groups = {f"{what}, {rung}": [to_original(s, rung)[i] for s in scenes]
              for i, what in enumerate(("kernel", "loop")) for rung in RUNGS[1:]}
    bars(ratio, groups, "times as fast as per-lane (Figure 9)")
    ratio.axhline(1, color="0.5", linewidth=0.8)
    figure.suptitle(scenes[0]["kernel"]["device"], fontsize=9)
    figure.tight_layout()
    figure.savefig(arguments.plot, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run")
    runner.add_argument("--build", required=True, help="the build directory")
    runner.add_argument("--data", required=True, help="the folder of the scenes")
    runner.add_argument("--scenes", nargs="+", required=True)
    runner.add_argument("--iterations", type=int, default=7000, help="where all rungs take equally many")
    runner.add_argument("--turns", type=int, default=1, help="of these, by all rungs; the medians count")
    runner.add_argument("--seconds", type=float, default=60, help="in the loop, where they take equally long; the paper's are 300")
    runner.add_argument("--seed", type=int, default=0)
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=run)
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.set_defaults(action=lambda arguments: print(tables(json.loads(pathlib.Path(arguments.file).read_text()))))
    plotter = commands.add_parser("plot")
    plotter.add_argument("file")
    plotter.add_argument("plot")
    plotter.set_defaults(action=plot)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    arguments.action(arguments)


if __name__ == "__main__":
    main()
