#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Measures held-out PSNR against seconds of training, and against the number of Gaussians, of real scenes.

    bench/fronts.py run --program build/bench/examples/gaussian_splatting/gaussian_splatting --data SCENES \\
        --before OLDER_PROGRAM --before-commit COMMIT --scenes lego fern --seeds 0 1 2 --output fronts.json \\
        -- --device cuda
    bench/fronts.py table fronts.json
    bench/fronts.py plot fronts.json docs/images/fronts          # needs matplotlib (Debian: python3-matplotlib)

`run` trains with each number of iterations for the first front, and with each limit of Gaussians for the
second. --before adds an older program, which takes turns with the program. The file is written after each
training, and the same command goes on where it was stopped. Longer lists of scenes, seeds or budgets add
trainings. Results of other options, commits or machines are refused; --fresh discards them. Options after --
go to all trainings of both programs.

`plot` writes PREFIX_seconds.svg and PREFIX_gaussians.svg with one panel per scene.
"""
import argparse
import concurrent.futures
import json
import pathlib
import statistics
import subprocess

from environment import compilers_of, environment, own_and_passed_on
from markdown_tables import markdown
from result_file import load, save
from scenes import by, on_cpu, spread, train

ITERATIONS = 7000  # of the trainings with a limit of Gaussians
KEY = ["front", "scene", "seed", "budget", "program"]
FRONTS = {
    "seconds": {"budget": "iterations", "axis": "seconds of training", "title": "Budgets of iterations",
                "columns": {"seconds": "{:.2f}", "PSNR": "{:.2f}", "Gaussians": "{:,.0f}"},
                "options": lambda iterations: ["-i", str(iterations)]},
    # Trainings at the same time slow each other down, so this front has no seconds.
    "gaussians": {"budget": "limit of Gaussians", "axis": "Gaussians", "title": f"Limits of Gaussians, {ITERATIONS:,} iterations",
                  "columns": {"PSNR": "{:.2f}", "Gaussians": "{:,.0f}"},
                  "options": lambda limit: ["-i", str(ITERATIONS), "--max-cap", str(limit)]},
}
# Colors of Okabe and Ito, which color-blind readers can tell apart.
STYLES = {"now": {"color": "#0072b2", "linestyle": "-", "marker": "o"},
          "before": {"color": "#d55e00", "linestyle": "--", "marker": "s"}}


def key_of(run):
    return tuple(run[name] for name in KEY)


def train_one(arguments, key):
    """The training of a key, with its figures. The older program has no other fields of metrics.json than these."""
    front, scene, seed, budget, name = key
    program = arguments.before if name == "before" else arguments.program
    options = [*arguments.options, *FRONTS[front]["options"](budget)]
    try:
        metrics = train(program, arguments.data, scene, seed, options)
    except subprocess.CalledProcessError as failed:
        raise SystemExit(f"error: exit status {failed.returncode} of {' '.join(map(str, failed.cmd))}")
    return {**dict(zip(KEY, key)), "seconds": metrics["seconds"]["train"],
            **{name: metrics[name] for name in ("psnr", "gaussians", "device")}}


def train_all(keys, jobs, one, keep):
    """Trains each key, `jobs` at a time, and keeps each result. After a failure, no training starts."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = set()
        for key in keys:
            if len(running) == jobs:
                done, running = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
                for training in done:
                    keep(training.result())
            running.add(pool.submit(one, key))
        for training in concurrent.futures.as_completed(running):
            keep(training.result())


def run(arguments):
    about = {"bench": "fronts", "options": arguments.options, **environment(arguments.commit),
             **compilers_of(pathlib.Path(arguments.program).resolve().parents[2]),
             "before_commit": arguments.before_commit}
    output = pathlib.Path(arguments.output)
    result = load(output, about, arguments.fresh) or {"about": about, "runs": []}

    def keep(one):
        result["runs"].append(one)
        save(output, result)
        print(*key_of(one), f"{one['seconds']:.1f} s, {one['psnr']:.2f} dB, {one['gaussians']} Gaussians", flush=True)

    known = set(map(key_of, result["runs"]))
    programs = ["now", "before"] if arguments.before else ["now"]
    for front, budgets, jobs in (("seconds", arguments.iterations, 1), ("gaussians", arguments.max_cap, arguments.jobs)):
        keys = [(front, scene, seed, budget, name) for scene in arguments.scenes for seed in arguments.seeds
                for budget in budgets for name in programs]
        train_all([key for key in keys if key not in known], jobs, lambda key: train_one(arguments, key), keep)


def points(runs):
    """The figures of each budget, in increasing order: a value per seed."""
    same = by("budget", runs)
    return {budget: {"seconds": [r["seconds"] for r in same[budget]], "PSNR": [r["psnr"] for r in same[budget]],
                     "Gaussians": [r["gaussians"] for r in same[budget]]} for budget in sorted(same)}


def where(result):
    """The machine, commits and seeds of a result, in words."""
    about, runs = result["about"], result["runs"]
    machine = about["processor"].strip() if on_cpu(runs) else about["gpu_and_driver"].replace(", ", ", driver ")
    commits = f"commit {about['commit']}" if about["before_commit"] is None else (
        f"commits {about['commit']} (now) and {about['before_commit']} (before)")
    seeds = {name: ", ".join(map(str, sorted({r["seed"] for r in same}))) for name, same in by("program", runs).items()}
    if len(set(seeds.values())) == 1:
        return f"{machine}, {commits}, seeds {next(iter(seeds.values()))}"
    return f"{machine}, {commits}, seeds " + " and ".join(f"{of} ({name})" for name, of in seeds.items())


def rows_of(columns, runs, programs):
    for scene, of_scene in by("scene", runs).items():
        found = {name: points(same) for name, same in by("program", of_scene).items()}
        for budget in sorted({r["budget"] for r in of_scene}):
            cells = [spread(found[name][budget][column], form) if budget in found.get(name, {}) else ""
                     for column, form in columns.items() for name in programs]
            yield [scene, f"{budget:,}", *cells]


def tables(result):
    text = []
    programs = [name for name in STYLES if name in by("program", result["runs"])]
    for front, runs in by("front", result["runs"]).items():
        about = FRONTS[front]
        names = [f"{column}, {name}" for column in about["columns"] for name in programs]
        text.append(f"{about['title']}; {where(result)}; median (least to most)\n\n" +
                    markdown(["scene", about["budget"], *names], rows_of(about["columns"], runs, programs)))
    return "\n".join(text)


def draw_curve(axis, front, name, scene, runs):
    """The medians as a line, and the PSNR of all seeds as a band."""
    column = "seconds" if front == "seconds" else "Gaussians"
    curve = sorted((statistics.median(p[column]), statistics.median(p["PSNR"]), min(p["PSNR"]), max(p["PSNR"]))
                   for p in points(runs).values())
    x, middle, least, most = zip(*curve)
    axis.fill_between(x, least, most, color=STYLES[name]["color"], alpha=0.2, linewidth=0)
    axis.plot(x, middle, **STYLES[name], linewidth=1.4, markersize=3.5, label=name, gid=f"{scene} {name}")


def draw(result, front, file):
    import matplotlib
    matplotlib.use("Agg")
    # The same file from the same figures, with text that stays text.
    matplotlib.rcParams.update({"svg.hashsalt": "warpagg", "svg.fonttype": "none", "font.size": 9,
                                "font.sans-serif": ["DejaVu Sans"]})
    from matplotlib import pyplot, ticker
    scenes = by("scene", [r for r in result["runs"] if r["front"] == front])
    columns = min(3, len(scenes))
    figure, axes = pyplot.subplots(-(-len(scenes) // columns), columns, squeeze=False, layout="constrained",
                                   figsize=(3 * columns, 0.8 + 2.1 * -(-len(scenes) // columns)))
    for axis in axes.flat[len(scenes):]:
        axis.remove()
    for axis, (scene, runs) in zip(axes.flat, scenes.items()):
        for name, same in by("program", runs).items():
            draw_curve(axis, front, name, scene, same)
        axis.set_xscale("log")
        axis.set_title(scene, fontsize=10)
        axis.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.xaxis.set_major_formatter("{x:g}" if front == "seconds" else ticker.EngFormatter(sep=""))
        axis.xaxis.set_minor_locator(ticker.NullLocator())
        axis.yaxis.set_major_locator(ticker.MaxNLocator(5, steps=(1, 2, 5, 10)))
        axis.tick_params(labelsize=8)
        axis.grid(alpha=0.25)
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=len(labels), frameon=False)
    figure.supylabel("held-out PSNR, dB", fontsize=10)
    figure.supxlabel(FRONTS[front]["axis"], fontsize=10)
    figure.text(0.5, -0.02, f"{where(result)}\nmedian; band: least to most", fontsize=8, ha="center", va="top")
    figure.savefig(file, bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)


def plot(arguments):
    result = json.loads(pathlib.Path(arguments.file).read_text())
    for front in by("front", result["runs"]):
        draw(result, front, f"{arguments.prefix}_{front}.svg")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run")
    runner.add_argument("--program", required=True)
    runner.add_argument("--before", metavar="PROGRAM", help="an older program, for a second curve")
    runner.add_argument("--before-commit", metavar="COMMIT", help="the commit of --before")
    runner.add_argument("--data", default=".", help="folder of the scenes")
    runner.add_argument("--scenes", nargs="+", required=True)
    runner.add_argument("--seeds", nargs="+", type=int, default=[0, 1, 2])
    runner.add_argument("--iterations", nargs="+", type=int, default=[250, 500, 1000, 2000, 4000, 7000, 15000, 30000],
                        help="budgets of the first front (default: %(default)s)")
    runner.add_argument("--max-cap", nargs="+", type=int, default=[10000, 20000, 40000, 80000, 160000, 320000, 640000],
                        help=f"limits of the second front, with {ITERATIONS} iterations (default: %(default)s)")
    runner.add_argument("--jobs", type=int, default=1,
                        help="trainings at a time for the second front, whose times do not count (default: 1)")
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--fresh", action="store_true", help="discard earlier results")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=run)
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.set_defaults(action=lambda arguments: print(tables(json.loads(pathlib.Path(arguments.file).read_text())), end=""))
    plotter = commands.add_parser("plot")
    plotter.add_argument("file")
    plotter.add_argument("prefix")
    plotter.set_defaults(action=plot)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    if arguments.action is run and (arguments.before is None) != (arguments.before_commit is None):
        parser.error("--before and --before-commit belong together")
    arguments.options = passed_on[0] if passed_on else []
    arguments.action(arguments)


if __name__ == "__main__":
    main()
